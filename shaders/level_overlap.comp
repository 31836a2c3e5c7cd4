// One lane per LEVEL_CHUNK node pairs: which child pairs overlap. Out: a mask a pair (low four bits: go on to the next
// level, next four: leaf pairs) and the chunk's sums.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "level.glsl"
#include "instances.glsl"
#if SOLIDS
#include "solid_nodes.glsl"
#endif
#include "verdicts.glsl"
#if TOLERANT
#include "tolerance.glsl"
#endif
layout(std430, binding = BINDING_A) writeonly buffer Masks { uint masks[]; };
layout(std430, binding = BINDING_B) writeonly buffer Sums { uvec2 sums[]; };

void main()
{
  const uint lane = invocationIndex();
  const uint entry_count = min(counters[in_counter], in_capacity);
  if (lane * LEVEL_CHUNK >= entry_count)
    return;
  uvec2 sum = uvec2(0u);
  const uint end = min((lane + 1u) * LEVEL_CHUNK, entry_count);
  for (uint i = lane * LEVEL_CHUNK; i < end; ++i)
  {
    const uvec4 entry = texelFetch(entries, int(i));
    const Item item = fetchItem(entry.x);
    const OrientedNode a = fetchOrientedNode(entry.y);
    const OrientedNode b = fetchOrientedNode(entry.z);
    const uint children = isDecided(item.state) ? 0u : childrenOf(a, b);
#if SOLIDS
    const Instance instance_a = fetchInstance(pairOther(item.pair));
    const Instance instance_b = fetchInstance(pairRobot(item.pair));
#endif
    bool inside = false;
    uint mask = 0u;
    for (uint c = 0u; c < 4u; ++c)
    {
      const uvec2 nodes = childPair(entry.yz, a, b, c);
      const OrientedNode child_a = fetchOrientedNode(nodes.x);
      const OrientedNode child_b = fetchOrientedNode(nodes.y);
      bool apart = nodesApart(child_a, child_b, item.pose, boxMargin(item.gap, item.error));
#if SOLIDS
      apart = apart || nodeBeyondSolid(child_a, child_b, instance_a, instance_b, item);
      inside = inside || nodeInCore(child_a, child_b, instance_a.core, instance_b.core, item.pose, boxError(item.error));
#endif
#if TOLERANT
      inside = inside || isCloseEnough(entry.x, item, child_a, child_b);
#endif
      const bool leaves = child_a.count != 0u && child_b.count != 0u;
      if (!apart && (children >> c & 1u) != 0u)
        mask |= (leaves ? 16u : 1u) << c;
    }
    if (inside)
    {
      report(item.state, item.pair, STATE_HIT);
      mask = 0u;
    }
    masks[i] = mask;
    sum += uvec2(bitCount(mask & 15u), bitCount(mask >> 4u));
  }
  sums[lane] = sum;
}
