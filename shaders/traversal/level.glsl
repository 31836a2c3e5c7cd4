// Breadth-first traversal, after Gress and Zachmann 2003: a level's node pairs all overlap; for each one the overlapping
// pairs of children are counted, the counts are summed as a tree (here of fan-in LEVEL_CHUNK, then one group over what
// is left, instead of the mip-map's four), and the sums place each pair of the next level, tightly packed. Pairs of leaves
// leave for a list of their own.
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "geometry/error_bounds.glsl"
#include "problem/oriented_nodes.glsl"
#include "common/counters.glsl"
layout(location = LOCATION_IN_COUNTER) uniform uint in_counter;
layout(location = LOCATION_OUT_COUNTER) uniform uint out_counter;
layout(location = LOCATION_ENTRY_CAPACITY) uniform uint entry_capacity;
layout(location = LOCATION_LEAF_PAIR_CAPACITY) uniform uint leaf_pair_capacity;
layout(location = LOCATION_IN_CAPACITY) uniform uint in_capacity;  // of the list read
layout(binding = UNIT_ENTRIES) uniform usamplerBuffer entries;

// The pairs that a node pair is taken apart into: both nodes' children where both are inner nodes, the inner node's
// children where one is, the pair itself where none is.
uvec2 childPair(uvec2 nodes, OrientedNode a, OrientedNode b, uint child)
{
  return uvec2(a.count == 0u ? a.first + (child & 1u) : nodes.x, b.count == 0u ? b.first + (child >> 1u) : nodes.y);
}

// Bit c is set where child pair c exists.
uint childrenOf(OrientedNode a, OrientedNode b)
{
  return (a.count == 0u ? 3u : 1u) * (b.count == 0u ? 5u : 1u);
}
