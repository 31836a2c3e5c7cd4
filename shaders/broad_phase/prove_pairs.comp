// One invocation per root pair whose state has no hit yet: the balls of the robot's covers prove most pairs apart or
// colliding. A pair without a proof becomes an entry of the traversal. Without covers, each pair does. Sources:
// broad_phase/covers.glsl.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "geometry/error_bounds.glsl"
#include "problem/instances.glsl"
#include "traversal/bounding_volume_overlap.glsl"
#include "common/counters.glsl"
#include "traversal/verdicts.glsl"
#include "traversal/solid_nodes.glsl"
#include "broad_phase/covers.glsl"
#include "broad_phase/roots.glsl"
layout(location = LOCATION_ROBOT_COUNT) uniform uint robot_count;
layout(location = LOCATION_ROOT_PAIR_CAPACITY) uniform uint root_pair_capacity;
layout(location = LOCATION_HAS_COVERS) uniform uint has_covers;
// The node pairs with which traversals begin: of two meshes, and of a mesh and a solid.
layout(std430, binding = BINDING_B) writeonly buffer MeshEntries { uvec4 mesh_entries[]; };
layout(std430, binding = BINDING_D) writeonly buffer SolidEntries { uvec4 solid_entries[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= min(counters[COUNTER_ROOT_PAIRS], root_pair_capacity))
    return;
  const RootPair pair = fetchRootPair(i);
  if (isDecided(pair.state))
    return;
  const uint other = pairOther(pair.pair);
  const uint robot = pairRobot(pair.pair);
  const Instance a = fetchInstance(other);
  const Instance b = fetchInstance(robot);
  const Roots roots = rootsOf(other, a, robot, b);
  uint proof = STATE_UNDECIDED;
  if (has_covers != 0u)
    proof = other >= robot_count ?
                proveWorldPair(pair, a, roots.a_is_solid, fetchOrientedNode(roots.a), fetchDistance(i)) :
                proveSelfPair(pair, fetchDistance(i));
  if (proof == STATE_HIT)
    report(pair.state, pair.pair, proof);
  if (proof != STATE_UNDECIDED)
    return;
  const uvec4 entry = uvec4(i, roots.a, roots.b, 0u);
  if (roots.a_is_solid || roots.b_is_solid)
    solid_entries[atomicAdd(counters[COUNTER_SOLID_ENTRIES], 1u)] = entry;
  else
    mesh_entries[atomicAdd(counters[COUNTER_MESH_ENTRIES], 1u)] = entry;
}
