// Step 1 of a level (level.glsl). One invocation per LEVEL_CHUNK node pairs: tests which child pairs overlap. Out: one
// mask per node pair (low four bits: pairs for the next level, next four bits: leaf pairs), and the sums of both for
// the work group. A pair that is proven to collide is reported, and its mask is 0.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/comparisons.glsl"
#include "common/invocation.glsl"
#include "traversal/level.glsl"
#include "problem/instances.glsl"
#if SOLIDS
#include "traversal/solid_nodes.glsl"
#endif
#include "traversal/verdicts.glsl"
#if PADDED
#include "traversal/close_enough.glsl"
#endif
layout(std430, binding = BINDING_A) writeonly buffer Masks { uint masks[]; };
layout(std430, binding = BINDING_B) writeonly buffer Sums { uvec2 sums[]; };

shared uint next_sum;
shared uint leaf_sum;

void main()
{
  if (gl_LocalInvocationID.x == 0u)
  {
    next_sum = 0u;
    leaf_sum = 0u;
  }
  barrier();
  uvec2 sum = uvec2(0u);
  const uint entry_count = min(counters[in_counter], in_capacity);
  const uint first = invocationIndex() * LEVEL_CHUNK;
  const uint end = min(first + LEVEL_CHUNK, entry_count);
  for (uint i = first; i < end; ++i)
  {
    const uvec4 entry = texelFetch(entries, int(i));
    const RootPair root_pair = fetchRootPair(entry.x);
    const OrientedNode a = fetchOrientedNode(entry.y);
    const OrientedNode b = fetchOrientedNode(entry.z);
    const uint children = isDecided(root_pair.state) ? 0u : childrenOf(a, b);
#if SOLIDS
    const Instance instance_a = fetchInstance(pairOther(root_pair.pair));
    const Instance instance_b = fetchInstance(pairRobot(root_pair.pair));
#endif
    bool inside = false;
    uint mask = 0u;
    for (uint c = 0u; c < 4u; ++c)
    {
      const uvec2 nodes = childPair(entry.yz, a, b, c);
      const OrientedNode child_a = fetchOrientedNode(nodes.x);
      const OrientedNode child_b = fetchOrientedNode(nodes.y);
      bool apart = nodesApart(child_a, child_b, root_pair.pose, root_pair.gap, root_pair.error);
#if SOLIDS
      apart = apart || nodeBeyondSolid(child_a, child_b, instance_a, instance_b, root_pair);
      inside = inside || nodeInCore(child_a, child_b, instance_a.core, instance_b.core, root_pair.pose,
                                    boxError(root_pair.error));
#endif
#if PADDED
      inside = inside || isCloseEnough(entry.x, root_pair, child_a, child_b);
#endif
      const bool leaves = child_a.count != 0u && child_b.count != 0u;
      if (!apart && (children >> c & 1u) != 0u)
        mask |= (leaves ? 16u : 1u) << c;
    }
    if (inside)
    {
      report(root_pair.state, root_pair.pair, STATE_HIT);
      mask = 0u;
    }
    masks[i] = mask;
    sum += uvec2(bitCount(mask & 15u), bitCount(mask >> 4u));
  }
  atomicAdd(next_sum, sum.x);
  atomicAdd(leaf_sum, sum.y);
  barrier();
  if (gl_LocalInvocationID.x == 0u && first < entry_count)
    sums[groupIndex()] = uvec2(next_sum, leaf_sum);
}
