// One work group per listed node: all its invocations together fit the oriented box of the node, as fit_boxes.comp
// does.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "problem/nodes.glsl"
#include "problem/triangles.glsl"
#include "tree_build/fit_output.glsl"
#include "tree_build/fit.glsl"
layout(location = LOCATION_FIRST_LISTED) uniform uint first_listed;
layout(location = LOCATION_LISTED_COUNT) uniform uint listed_count;
layout(std430, binding = BINDING_LARGE_NODES) readonly buffer LargeNodes { uvec4 large_nodes[]; };

shared Spread spreads[GROUP_SIZE];
shared Extents all_extents[GROUP_SIZE];
shared vec4 chosen_axes[FIT_BOXES];

void main()
{
  const uint invocation = gl_LocalInvocationID.x;
  const uvec4 listed = large_nodes[first_listed + min(groupIndex(), listed_count - 1u)];
  const TreeNode node = fetchNode(listed.x);
  const uint end = listed.y + listed.z;
  vec3 corners[3];
  Spread spread = emptySpread(listed.y);
  for (uint k = listed.y + invocation; k < end; k += GROUP_SIZE)
  {
    fetchAround(k, node.box.center, corners);
    add(spread, corners, k);
  }
  spreads[invocation] = spread;
  barrier();
  if (invocation == 0u)
  {
    for (uint other = 1u; other < GROUP_SIZE; ++other)
      join(spread, spreads[other]);
    chooseAxes(spread, listed.z, node.box.center, chosen_axes);
  }
  barrier();
  mat3 rotations[FIT_BOXES];
  for (int box = 0; box < FIT_BOXES; ++box)
    rotations[box] = rotationOf(chosen_axes[box]);
  Extents extents = emptyExtents();
  for (uint k = listed.y + invocation; k < end; k += GROUP_SIZE)
  {
    fetchAround(k, node.box.center, corners);
    extend(extents, corners, rotations);
  }
  all_extents[invocation] = extents;
  barrier();
  if (invocation == 0u)
  {
    for (uint other = 1u; other < GROUP_SIZE; ++other)
      for (int box = 0; box < FIT_BOXES; ++box)
      {
        extents.low[box] = min(extents.low[box], all_extents[other].low[box]);
        extents.high[box] = max(extents.high[box], all_extents[other].high[box]);
      }
    writeBest(listed.x, node, extents, chosen_axes);
  }
}
