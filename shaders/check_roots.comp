// One lane per candidate: the relative pose, the test of the root boxes, and whether one is inside the other, a solid.
// What remains becomes an item and the node pair that its traversal begins with.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#define WRITES_ITEMS
#include "items.glsl"
#include "boxes.glsl"
#include "geometries.glsl"
#include "counters.glsl"
#include "verdicts.glsl"
#include "containment.glsl"
layout(location = 2) uniform uint candidate_capacity;
layout(location = 3) uniform uint item_capacity;
layout(binding = UNIT_ROBOT_POSES) uniform usamplerBuffer robot_poses;
layout(binding = UNIT_WORLD_POSES) uniform usamplerBuffer world_poses;
layout(binding = UNIT_CANDIDATES) uniform usamplerBuffer candidates;
layout(std430, binding = BINDING_OUT) writeonly buffer Items { uvec4 items[]; };
layout(std430, binding = BINDING_OUT_2) writeonly buffer Entries { uvec4 entries[]; };

float sum(vec3 v)
{
  return abs(v.x) + abs(v.y) + abs(v.z);
}

void main()
{
  const uint i = invocationIndex();
  if (i >= min(counters[COUNTER_CANDIDATES], candidate_capacity))
    return;
  const uvec4 candidate = texelFetch(candidates, int(i));
  const uint state = candidate.x;
  const uint robot = pairRobot(candidate.y);
  const uint other = pairOther(candidate.y);
  const Pose a = fetchPose(robot_poses, poseIndex(state, robot));
  Pose b;
  if (other < robot_count)
    b = fetchPose(robot_poses, poseIndex(state, other));
  else
    b = fetchPose(world_poses, other - robot_count);
  const Pose pose = relativePose(a, b);
  const Instance instance_a = fetchInstance(robot);
  const Instance instance_b = fetchInstance(other);
  const float slack = instance_a.slack + instance_b.slack;
  const Box box_a = fetchNode(instance_a.root).box;
  const Box box_b = fetchNode(instance_b.root).box;
  // Both poses were rounded to float, multiplied, and are applied to points as far out as the boxes reach.
  const float error = 16.0 * 1.1920929e-7 * (sum(a.translation) + sum(b.translation) + sum(box_a.center) + sum(box_a.extent) +
                                             sum(box_b.center) + sum(box_b.extent));
  if (boxesApart(box_a, box_b, pose, slack + error))
    return;
  const uint inside = containment(instance_b, instance_a, pose, error) | containment(instance_a, instance_b, inversePose(pose), error);
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
  for (int row = 0; row < 3; ++row)
    items[4u * at + uint(row)] = floatBitsToUint(vec4(rows[row], pose.translation[row]));
  items[4u * at + 3u] = uvec4(state, candidate.y, floatBitsToUint(slack), floatBitsToUint(error));
  entries[at] = uvec4(at, instance_a.root, instance_b.root, 0u);
}
