// One invocation per candidate: if its other body is a half-space, tests whether the shape reaches into it, and reports
// the verdict. The corner with the least height above the plane decides. A traversal of the shape's tree finds
// it, with the test of a box against a plane (Ericson 2005, "Real-Time Collision Detection", 5.2.3). The triangles of a
// curved shape lie inside its true surface, so the slack is added to the gap. Lengths are in metres.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "common/lists.glsl"
#include "geometry/pose.glsl"
#include "problem/nodes.glsl"
#include "geometry/error_bounds.glsl"
#include "problem/instance_lists.glsl"
#include "traversal/verdicts.glsl"
#include "problem/triangles.glsl"
#include "problem/margins.glsl"
layout(location = LOCATION_WORLD_COUNT) uniform uint world_count;
layout(location = LOCATION_CANDIDATE_CAPACITY) uniform uint candidate_capacity;
layout(binding = UNIT_CANDIDATES) uniform usamplerBuffer candidates;
layout(binding = UNIT_ROBOT_POSES) uniform usamplerBuffer robot_poses;
// First texel of a half-space: the normal and the offset of its plane. Second texel: its padding.
layout(std430, binding = BINDING_C) readonly buffer HalfSpaces { vec4 half_spaces[]; };

// Returns STATE_* bits: STATE_HIT if a corner is proven to lie at most `distance` above the plane, STATE_UNDECIDED if a
// corner may lie at most `gap` above it. The normal and the offset are in the frame of the tree.
uint reachesDown(uint root, vec3 normal, float offset, float error, float distance, float gap)
{
  uint stack[BUILD_ROUNDS + 2];
  stack[0] = root;
  int top = 1;
  uint found = 0u;
  for (uint steps = 0u;
       top > 0 && (found & STATE_HIT) == 0u && steps < uint(INVOCATION_ITERATIONS) / (4u * LEAF_TRIANGLES); ++steps)
  {
    const TreeNode node = fetchNode(stack[--top]);
    const float height = dot(normal, node.box.center) - offset;
    const float extent = dot(abs(normal), node.box.extent);
    if (height - extent > gap + error)
      continue;
    if (node.count == 0u)
    {
      stack[top] = node.first;
      stack[top + 1] = node.first + 1u;
      top += 2;
      continue;
    }
    for (uint i = node.first; i < node.first + node.count; ++i)
    {
      vec3 corners[3];
      fetchTriangle(i, corners);
      for (int k = 0; k < 3; ++k)
      {
        const float above = dot(normal, corners[k]) - offset;
        found |= above + error <= distance ? STATE_HIT
                                           : (above > gap + error && FLOAT32_TRUSTED != 0 ? 0u : STATE_UNDECIDED);
      }
    }
  }
  // Nodes are left on the stack if the steps ran out or the device ended the loop. Their triangles were not tested.
  return top > 0 && (found & STATE_HIT) == 0u ? STATE_UNDECIDED : found;
}

void main()
{
  const uint i = invocationIndex();
  if (i >= lengthOf(LIST_CANDIDATES, candidate_capacity))
    return;
  const uvec4 two = texelFetch(candidates, int(i / 2u));
  const uint state = i % 2u == 0u ? two.x : two.z;
  const uint pair = i % 2u == 0u ? two.y : two.w;
  if (pairOther(pair) < robot_count + world_count || isDecided(state))
    return;
  const uint robot = pairRobot(pair);
  const uint half_space = pairOther(pair) - robot_count - world_count;
  const Instance instance = fetchInstance(robot);
  const Pose pose = fetchPose(robot_poses, poseIndex(state, robot));
  const vec4 plane = half_spaces[HALF_SPACE_TEXELS * half_space];
  const float distance =
      instance.padding + half_spaces[HALF_SPACE_TEXELS * half_space + 1u].x + worldMargin(state, robot);
  const float error = planeError(pose, farCorner(fetchNode(instance.root).box), plane.w);
  const vec3 normal = plane.xyz * pose.rotation;
  precise const float offset = plane.w - dot(plane.xyz, pose.translation);
  const uint found = reachesDown(instance.root, normal, offset, error, distance * (1.0 - 4.0 * u),
                                 requiredGap(distance, instance.slack));
  if (found != 0u)
    report(state, pair, found);
}
