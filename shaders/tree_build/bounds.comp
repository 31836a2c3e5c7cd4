// One invocation per primitive: computes the bounds of the box centres of each mesh, as integers in the order of the
// floats. In: the boxes of boxes.comp.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/cluster.glsl"
layout(location = LOCATION_PRIMITIVE_COUNT) uniform uint primitive_count;
layout(std430, binding = BINDING_BOXES) readonly buffer Boxes { uvec4 boxes[]; };
layout(std430, binding = BINDING_MESH_OF) readonly buffer MeshOf { uint mesh_of[]; };
// Of each mesh: ~(lowest x, y, z), highest x, y, z.
layout(std430, binding = BINDING_BOUNDS) buffer Bounds { uint bounds[]; };

// Maps floats to unsigned integers of the same order (Herf 2001, "Radix Tricks").
uint ordered(float value)
{
  const uint bits = floatBitsToUint(value);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

void main()
{
  const uint i = invocationIndex();
  if (i >= primitive_count)
    return;
  const Cluster box = unpackCluster(boxes[CLUSTER_TEXELS * i], boxes[CLUSTER_TEXELS * i + 1u]);
  const vec3 center = 0.5 * box.low + 0.5 * box.high;
  const uint mesh = BOUNDS_WORDS * mesh_of[i];
  for (uint axis = 0u; axis < 3u; ++axis)
  {
    // The complement turns a minimum into a maximum, so a buffer of zeros is the right start for both.
    atomicMax(bounds[mesh + axis], ~ordered(center[axis]));
    atomicMax(bounds[mesh + 3u + axis], ordered(center[axis]));
  }
}
