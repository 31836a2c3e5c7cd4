// One lane per candidate: the relative pose, the test of the root boxes, and whether one is inside the other, a solid.
// What remains becomes an item and the node pair that its traversal begins with.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#define WRITES_ITEMS
#include "items.glsl"
#include "boxes.glsl"
#include "error_bounds.glsl"
#include "geometries.glsl"
#include "counters.glsl"
#include "verdicts.glsl"
#include "containment.glsl"
layout(location = 2) uniform uint candidate_capacity;
layout(location = 3) uniform uint item_capacity;
layout(binding = UNIT_ROBOT_POSES) uniform usamplerBuffer robot_poses;
layout(binding = UNIT_WORLD_POSES) uniform usamplerBuffer world_poses;
layout(binding = UNIT_CANDIDATES) uniform usamplerBuffer candidates;
layout(std430, binding = BINDING_A) writeonly buffer Items { uvec4 items[]; };
layout(std430, binding = BINDING_B) writeonly buffer Entries { uvec4 entries[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= min(counters[COUNTER_CANDIDATES], candidate_capacity))
    return;
  const uvec4 two = texelFetch(candidates, int(i / 2u));
  const uvec2 candidate = i % 2u == 0u ? two.xy : two.zw;
  const uint state = candidate.x;
  const uint robot = pairRobot(candidate.y);
  const uint other = pairOther(candidate.y);
  const bool world = other >= robot_count;
  Pose pose_a;
  if (world)
    pose_a = fetchPose(world_poses, other - robot_count);
  else
    pose_a = fetchPose(robot_poses, poseIndex(state, other));
  const Pose pose_b = fetchPose(robot_poses, poseIndex(state, robot));
  const Pose pose = relativePose(pose_a, pose_b);
  const Instance a = fetchInstance(other);
  const Instance b = fetchInstance(robot);
  const Box box_a = fetchNode(a.root).box;
  const Box box_b = fetchNode(b.root).box;
  const vec3 far_a = farCorner(box_a);
  const float error = positionError(pose_a, pose_b, pose, far_a, farCorner(box_b));
  const float distance = world ? a.padding + b.padding : 0.0;
  const float gap = requiredGap(distance, a.slack + b.slack);
  if (boxesApart(box_a, box_b, pose, gap + boxError(error)))
    return;
  const uint inside = containment(b, a, pose, boxError(error)) | containment(a, b, inversePose(pose), inverseError(error, far_a));
  if (inside != 0u)
    report(state, candidate.y, inside);
  if ((inside & STATE_HIT) != 0u)
    return;
  const uint at = atomicAdd(counters[COUNTER_ITEMS], 1u);
  if (at >= item_capacity)
  {
    atomicOr(counters[COUNTER_OVERFLOW], 1u);
    return;
  }
  const mat3 rows = transpose(pose.rotation);
  const uint texel = at * ITEM_TEXELS;
  for (int row = 0; row < 3; ++row)
    items[texel + uint(row)] = floatBitsToUint(vec4(rows[row], pose.translation[row]));
  items[texel + 3u] = uvec4(state, candidate.y, floatBitsToUint(error), floatBitsToUint(gap));
  items[texel + 4u] = uvec4(floatBitsToUint(distance), 0u, 0u, 0u);
  entries[at] = uvec4(at, a.root, b.root, 0u);
}
