// One lane per (state, robot instance): the sphere around its root box in the planning frame, for the broad phase among links,
// and the broad phase against the world, a walk of the tree over world instances with the box around its root box.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "geometries.glsl"
#include "candidates.glsl"
#include "pose.glsl"
#include "boxes.glsl"
layout(location = 3) uniform uint world_count;
layout(binding = UNIT_ROBOT_POSES) uniform usamplerBuffer robot_poses;
layout(std430, binding = BINDING_A) writeonly buffer Spheres { vec4 spheres[]; };  // centre and radius
// A node: its box's centre, and which node comes next where the boxes are apart; half extents, and the instance or NO_OBJECT.
// Where they overlap, the next node in the list comes next, so no stack is needed; past the last one the walk ends.
layout(binding = UNIT_OBJECT_TREE) uniform usamplerBuffer object_tree;
layout(binding = UNIT_WORLD_PAIRS) uniform usamplerBuffer world_pairs;

bool isChecked(uint robot, uint world)
{
  const uint bit = robot * world_count + world;
  return (texelFetch(world_pairs, int(bit >> 7u))[bit >> 5u & 3u] >> (bit & 31u) & 1u) != 0u;
}

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
  // 1e-5: rounding of the pose, of the product and of the comparison, relative to all lengths that enter. What an object's
  // own box needs, its rounding outwards provides.
  const float error = 1e-5 * (abs(center.x) + abs(center.y) + abs(center.z) + length(box.center) + length(box.extent));
  spheres[i] = vec4(center, length(box.extent) + instance.slack + CONTRACT_BAND + error);
  if (!instance.meets_world)
    return;
  const mat3 q = mat3(abs(pose.rotation[0]), abs(pose.rotation[1]), abs(pose.rotation[2]));
  const vec3 extent = q * box.extent + instance.slack + instance.padding + CONTRACT_BAND + error;

  const uint node_count = max(2u * world_count, 1u) - 1u;
  uint at = 0u;
  for (uint steps = 0u; at < node_count && steps < LANE_ITERATIONS / 2u; ++steps)
  {
    const uvec4 head = texelFetch(object_tree, int(2u * at));
    const uvec4 tail = texelFetch(object_tree, int(2u * at + 1u));
    const bool apart = any(greaterThan(abs(uintBitsToFloat(head.xyz) - center), uintBitsToFloat(tail.xyz) + extent));
    // A loop: it costs only those that take it.
    for (bool leaf = !apart && tail.w != NO_OBJECT && isChecked(robot, tail.w); leaf; leaf = false)
      addCandidate(state, packPair(robot, robot_count + tail.w));
    at = apart ? head.w : at + 1u;
  }
  // Too many objects for one lane: what is left is not lost, the batch is split and its states become undecided.
  if (at < node_count)
    atomicOr(counters[COUNTER_OVERFLOW], 1u);
}
