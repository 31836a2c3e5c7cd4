// One invocation per primitive: computes the Morton code of the centre of its box within the bounds of its mesh, 10
// bits an axis (Lauterbach et al. 2009, "Fast BVH Construction on GPUs"). In: the boxes of boxes.comp, the bounds of
// bounds.comp.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/cluster.glsl"
layout(location = LOCATION_PRIMITIVE_COUNT) uniform uint primitive_count;
layout(std430, binding = BINDING_BOXES) readonly buffer Boxes { uvec4 boxes[]; };
layout(std430, binding = BINDING_MESH_OF) readonly buffer MeshOf { uint mesh_of[]; };
layout(std430, binding = BINDING_BOUNDS) readonly buffer Bounds { uint bounds[]; };
layout(std430, binding = BINDING_KEYS_OUT) writeonly buffer Keys { uvec2 keys[]; };  // (Morton code, primitive)

// The inverse of `ordered` in bounds.comp.
float unordered(uint key)
{
  return uintBitsToFloat((key & 0x80000000u) != 0u ? key & 0x7fffffffu : ~key);
}

// Inserts two zero bits between each two of the lowest ten bits.
uint spread(uint x)
{
  x = (x | (x << 16u)) & 0x030000ffu;
  x = (x | (x << 8u)) & 0x0300f00fu;
  x = (x | (x << 4u)) & 0x030c30c3u;
  x = (x | (x << 2u)) & 0x09249249u;
  return x;
}

void main()
{
  const uint i = invocationIndex();
  if (i >= primitive_count)
    return;
  const Cluster box = unpackCluster(boxes[CLUSTER_TEXELS * i], boxes[CLUSTER_TEXELS * i + 1u]);
  const vec3 center = 0.5 * box.low + 0.5 * box.high;
  const uint mesh = BOUNDS_WORDS * mesh_of[i];
  vec3 low;
  vec3 high;
  for (uint axis = 0u; axis < 3u; ++axis)
  {
    low[axis] = unordered(~bounds[mesh + axis]);
    high[axis] = unordered(bounds[mesh + 3u + axis]);
  }
  // One scale for all axes, so that the cells are cubes. Otherwise, flat and long meshes would be split too often along
  // their thin axes.
  const vec3 extent = high - low;
  const float size = max(extent.x, max(extent.y, extent.z));
  const vec3 unit = size > 0.0 ? clamp((center - low) / size, 0.0, 1.0) : vec3(0.0);
  const uvec3 cell = min(uvec3(unit * 1024.0), uvec3(1023u));
  keys[i] = uvec2(spread(cell.x) | (spread(cell.y) << 1u) | (spread(cell.z) << 2u), i);
}
