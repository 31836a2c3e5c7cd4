// One invocation per candidate: computes the relative pose and tests the root boxes. If one shape is a primitive, it
// also tests whether the other shape is inside this primitive. A candidate that remains becomes a root pair
// (traversal/root_pairs.glsl) and an entry of the traversal. Sources: traversal/bounding_volume_overlap.glsl. Lengths
// are in metres.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#define WRITES_ROOT_PAIRS
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "geometry/error_bounds.glsl"
#include "traversal/bounding_volume_overlap.glsl"
#include "problem/instance_lists.glsl"
#include "common/lists.glsl"
#include "traversal/verdicts.glsl"
#include "broad_phase/primitive_containment.glsl"
#include "broad_phase/roots.glsl"
#include "problem/margins.glsl"
layout(location = LOCATION_WORLD_COUNT) uniform uint world_count;
layout(location = LOCATION_CANDIDATE_CAPACITY) uniform uint candidate_capacity;
layout(location = LOCATION_ROOT_PAIR_CAPACITY) uniform uint root_pair_capacity;
layout(binding = UNIT_ROBOT_POSES) uniform usamplerBuffer robot_poses;
layout(binding = UNIT_WORLD_POSES) uniform usamplerBuffer world_poses;
layout(binding = UNIT_CANDIDATES) uniform usamplerBuffer candidates;
layout(std430, binding = BINDING_A) writeonly buffer RootPairs { uvec4 root_pairs[]; };
// The node pairs with which traversals begin: of two meshes, and of a mesh and a solid.
layout(std430, binding = BINDING_B) writeonly buffer MeshEntries { uvec4 mesh_entries[]; };
layout(std430, binding = BINDING_D) writeonly buffer SolidEntries { uvec4 solid_entries[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= lengthOf(LIST_CANDIDATES, candidate_capacity))
    return;
  const uvec4 two = texelFetch(candidates, int(i / 2u));
  const uvec2 candidate = i % 2u == 0u ? two.xy : two.zw;
  const uint state = candidate.x;
  const uint robot = pairRobot(candidate.y);
  const uint other = pairOther(candidate.y);
  if (other >= robot_count + world_count || isDecided(state))  // half_spaces.comp tests half-spaces
    return;
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
  const Roots roots = rootsOf(other, a, robot, b);
  const Box box_a = fetchNode(roots.a).box;
  const Box box_b = fetchNode(roots.b).box;
  const vec3 far_a = farCorner(box_a);
  const float error = positionError(pose_a, pose_b, pose, far_a, farCorner(box_b));
  const float distance = world ? a.padding + b.padding + worldMargin(state, robot) : selfMargin(state, robot, other);
  const float gap = requiredGap(distance, (roots.a_is_solid ? 0.0 : a.slack) + (roots.b_is_solid ? 0.0 : b.slack));
  if (nodesApart(fetchOrientedNode(roots.a), fetchOrientedNode(roots.b), pose, gap, error))
    return;
  // A shape that is tested as a solid needs no certain result here: the traversal also finds triangles inside it. So an
  // uncertain result is dropped.
  uint inside = containment(b, a, pose, boxError(error)) & (roots.a_is_solid ? STATE_HIT : ~0u);
  inside |= containment(a, b, inversePose(pose), inverseError(error, far_a)) & (roots.b_is_solid ? STATE_HIT : ~0u);
  if (inside != 0u)
    report(state, candidate.y, inside);
  if ((inside & STATE_HIT) != 0u)
    return;
  const uint at = newEntries(LIST_ROOT_PAIRS, 1u, root_pair_capacity, GROUP_SIZE);
  if (at >= root_pair_capacity)
    return;
  const mat3 rows = transpose(pose.rotation);
  const uint texel = at * ROOT_PAIR_TEXELS;
  for (int row = 0; row < 3; ++row)
    root_pairs[texel + uint(row)] = floatBitsToUint(vec4(rows[row], pose.translation[row]));
  root_pairs[texel + 3u] = uvec4(state, candidate.y, floatBitsToUint(error), floatBitsToUint(gap));
  root_pairs[texel + 4u] = uvec4(floatBitsToUint(distance), 0u, 0u, 0u);
  const uvec4 entry = uvec4(at, roots.a, roots.b, 0u);
  if (roots.a_is_solid || roots.b_is_solid)
    solid_entries[newEntries(LIST_SOLID_ENTRIES, 1u, root_pair_capacity, QUEUE_INVOCATIONS)] = entry;
  else
    mesh_entries[newEntries(LIST_MESH_ENTRIES, 1u, root_pair_capacity, QUEUE_INVOCATIONS)] = entry;
}
