// Breadth-first traversal (after Gress and Zachmann 2003). All node pairs of a level overlap. First the overlapping
// pairs of children of each node pair are counted. The counts are then summed as a tree. The sums finally place each
// pair of the next level, tightly packed. Gress and Zachmann sum with a mip map of fan-in 4. Here each work group sums
// the counts of LEVEL_GROUP node pairs, and one work group sums the rest. Pairs of leaves go to a list of their own.
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "geometry/error_bounds.glsl"
#include "traversal/bounding_volume_overlap.glsl"
#include "common/counters.glsl"
layout(location = LOCATION_IN_COUNTER) uniform uint in_counter;
layout(location = LOCATION_OUT_COUNTER) uniform uint out_counter;
layout(location = LOCATION_ENTRY_CAPACITY) uniform uint entry_capacity;
layout(location = LOCATION_LEAF_PAIR_CAPACITY) uniform uint leaf_pair_capacity;
layout(location = LOCATION_IN_CAPACITY) uniform uint in_capacity;  // of the list that is read
layout(binding = UNIT_ENTRIES) uniform usamplerBuffer entries;

// Child pair `child` of a node pair. Two inner nodes have four pairs of children. An inner node and a leaf have two
// pairs of the inner node's children with the leaf. Two leaves have one, themselves.
uvec2 childPair(uvec2 nodes, OrientedNode a, OrientedNode b, uint child)
{
  return uvec2(a.count == 0u ? a.first + (child & 1u) : nodes.x, b.count == 0u ? b.first + (child >> 1u) : nodes.y);
}

// Bit c is set if child pair c exists.
uint childrenOf(OrientedNode a, OrientedNode b)
{
  return (a.count == 0u ? 3u : 1u) * (b.count == 0u ? 5u : 1u);
}
