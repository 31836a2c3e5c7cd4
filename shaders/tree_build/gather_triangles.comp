// One invocation per triangle, in leaf order: writes three texels with its vertices (metres, mesh's frame); w is
// unused.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
layout(location = LOCATION_FIRST_TRIANGLE) uniform uint first_triangle;  // the forest's first one among all
layout(location = LOCATION_TRIANGLE_COUNT) uniform uint triangle_count;
layout(std430, binding = BINDING_VERTICES) readonly buffer Vertices { float vertices[]; };
layout(std430, binding = BINDING_LEAF_ORDER) readonly buffer LeafOrder { uint leaf_order[]; };
layout(std430, binding = BINDING_TRIANGLES) writeonly buffer Triangles { uvec4 triangles[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= triangle_count)
    return;
  const uint source = (leaf_order[first_triangle + i] - first_triangle) * TRIANGLE_FLOATS;
  for (uint corner = 0u; corner < 3u; ++corner)
  {
    const uint at = source + 3u * corner;
    triangles[TRIANGLE_TEXELS * (first_triangle + i) + corner] =
        uvec4(floatBitsToUint(vec3(vertices[at], vertices[at + 1u], vertices[at + 2u])), 0u);
  }
}
