// Broad phase against the world: one lane per (state, robot instance) walks the tree over world instances with the box
// around its root box in the planning frame.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "geometries.glsl"
#include "candidates.glsl"
#include "pose.glsl"
#include "boxes.glsl"
layout(location = 3) uniform uint world_count;
layout(location = 4) uniform uint world_root;
layout(binding = UNIT_ROBOT_POSES) uniform usamplerBuffer robot_poses;
layout(std430, binding = BINDING_C) readonly buffer WorldOrder { uint world_order[]; };     // leaf order of the tree
layout(std430, binding = BINDING_D) readonly buffer WorldPairs { uint world_pairs[]; };   // bits [robot][world]

void main()
{
  const uint i = invocationIndex();
  if (i >= state_count * robot_count)
    return;
  const uint state = stateOf(i);
  const uint robot = robotOf(i);
  const Instance instance = fetchInstance(robot);
  const Box box = fetchNode(instance.root).box;
  const Pose pose = fetchPose(robot_poses, poseIndex(state, robot));
  const vec3 center = apply(pose, box.center);
  // What the object's own box needs, its rounding outwards in layout.glsl provides.
  const float error = 1e-5 * (abs(center.x) + abs(center.y) + abs(center.z) + length(box.center) + length(box.extent));
  const mat3 q = mat3(abs(pose.rotation[0]), abs(pose.rotation[1]), abs(pose.rotation[2]));
  const vec3 extent = q * box.extent + instance.slack + instance.padding + CONTRACT_BAND + error;

  // The depth of a tree is at most BUILD_ROUNDS, and one of each two children waits.
  uint stack[BUILD_ROUNDS + 2];
  stack[0] = world_root;
  int top = 1;
  for (uint steps = 0u; top > 0 && steps < LANE_ITERATIONS; ++steps)
  {
    const TreeNode node = fetchNode(stack[--top]);
    const bool apart = any(greaterThan(abs(node.box.center - center), node.box.extent + extent));
    if (apart)
      continue;
    if (node.count == 0u)
    {
      stack[top] = node.first;
      stack[top + 1] = node.first + 1u;
      top += 2;
    }
    else
    {
      const uint world = world_order[node.first];
      const uint bit = robot * world_count + world;
      if ((world_pairs[bit >> 5u] >> (bit & 31u) & 1u) != 0u)
        addCandidate(state, packPair(robot, robot_count + world));
    }
  }
  // Too many objects for one lane: what is left is not lost, the batch is split and its states become undecided.
  if (top > 0)
    atomicOr(counters[COUNTER_OVERFLOW], 1u);
}
