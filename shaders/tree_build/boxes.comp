// One invocation per triangle: computes its box, rounded outwards so that it holds the double-precision vertices from
// which the floats were rounded. In: TRIANGLE_FLOATS a triangle, metres, in the mesh's frame. Out: a cluster for each
// triangle (cluster.glsl).
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/cluster.glsl"
layout(location = LOCATION_TRIANGLE_COUNT) uniform uint triangle_count;
layout(std430, binding = BINDING_VERTICES) readonly buffer Vertices { float vertices[]; };
layout(std430, binding = BINDING_BOXES) writeonly buffer Boxes { uvec4 boxes[]; };

vec3 vertex(uint triangle, uint corner)
{
  const uint at = triangle * TRIANGLE_FLOATS + corner * 3u;
  return vec3(vertices[at], vertices[at + 1u], vertices[at + 2u]);
}

void main()
{
  const uint i = invocationIndex();
  if (i >= triangle_count)
    return;
  const vec3 a = vertex(i, 0u);
  const vec3 b = vertex(i, 1u);
  const vec3 c = vertex(i, 2u);
  const vec3 low = min(a, min(b, c));
  const vec3 high = max(a, max(b, c));
  // A relative 2^-23 covers the conversion's half unit in the last place; 1e-37 covers numbers that are flushed to
  // zero.
  Cluster box;
  box.low = low - (abs(low) * UNIT_ROUNDOFF + 1e-37);
  box.high = high + (abs(high) * UNIT_ROUNDOFF + 1e-37);
  box.reference = i;
  box.count = 1u;
  box.opened = false;
  boxes[CLUSTER_TEXELS * i] = packLow(box);
  boxes[CLUSTER_TEXELS * i + 1u] = packHigh(box);
}
