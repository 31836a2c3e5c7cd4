// Step 3 of a level (level.glsl). One invocation per LEVEL_CHUNK node pairs: writes the overlapping child pairs to
// their places in the lists. In: the masks of level_overlap.comp, and the prefix sums of level_scan.comp. Out: the node
// pairs of the next level, and the leaf pairs.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "traversal/level.glsl"
layout(std430, binding = BINDING_A) readonly buffer Masks { uint masks[]; };
layout(std430, binding = BINDING_B) readonly buffer Sums { uvec2 sums[]; };
layout(std430, binding = BINDING_C) writeonly buffer NextEntries { uvec4 next_entries[]; };
layout(std430, binding = BINDING_D) writeonly buffer LeafPairs { uvec4 leaf_pairs[]; };

void main()
{
  const uint invocation = invocationIndex();
  const uint entry_count = min(counters[in_counter], in_capacity);
  if (invocation * LEVEL_CHUNK >= entry_count)
    return;
  uvec2 at = sums[invocation];
  const uint end = min((invocation + 1u) * LEVEL_CHUNK, entry_count);
  for (uint i = invocation * LEVEL_CHUNK; i < end; ++i)
  {
    const uint mask = masks[i];
    const uvec4 entry = texelFetch(entries, int(i));
    const OrientedNode a = fetchOrientedNode(entry.y);
    const OrientedNode b = fetchOrientedNode(entry.z);
    for (uint c = 0u; c < 4u; ++c)
    {
      const uvec2 nodes = childPair(entry.yz, a, b, c);
      if ((mask >> c & 1u) != 0u)
      {
        if (at.x < entry_capacity)
          next_entries[at.x] = uvec4(entry.x, nodes, 0u);
        ++at.x;
      }
      if ((mask >> (c + 4u) & 1u) != 0u)
      {
        const OrientedNode child_a = fetchOrientedNode(nodes.x);
        const OrientedNode child_b = fetchOrientedNode(nodes.y);
        if (at.y < leaf_pair_capacity)
          leaf_pairs[at.y] = uvec4(entry.x, leafReference(child_a.first, child_a.count),
                                   leafReference(child_b.first, child_b.count), 0u);
        ++at.y;
      }
    }
  }
}
