// Step 3 of a level (level.glsl). One invocation per LEVEL_CHUNK node pairs: writes the overlapping child pairs to
// their places in the lists. In: the masks of level_overlap.comp, and the prefix sums of level_sizes.comp, which are
// the first places of each work group. Out: the node pairs of the next level, and the leaf pairs.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "traversal/level.glsl"
layout(std430, binding = BINDING_A) readonly buffer Masks { uint masks[]; };
layout(std430, binding = BINDING_B) readonly buffer Sums { uvec2 sums[]; };
layout(std430, binding = BINDING_C) writeonly buffer NextEntries { uvec4 next_entries[]; };
layout(std430, binding = BINDING_D) writeonly buffer LeafPairs { uvec4 leaf_pairs[]; };

shared uint next_place;
shared uint leaf_place;

void main()
{
  const uint entry_count = min(counters[in_counter], in_capacity);
  const uint first = invocationIndex() * LEVEL_CHUNK;
  const uint end = min(first + LEVEL_CHUNK, entry_count);
  if (gl_LocalInvocationID.x == 0u)
  {
    const uvec2 place = first < entry_count ? sums[groupIndex()] : uvec2(0u);
    next_place = place.x;
    leaf_place = place.y;
  }
  barrier();
  uvec2 sum = uvec2(0u);
  for (uint i = first; i < end; ++i)
    sum += uvec2(bitCount(masks[i] & 15u), bitCount(masks[i] >> 4u));
  uvec2 at = uvec2(atomicAdd(next_place, sum.x), atomicAdd(leaf_place, sum.y));
  for (uint i = first; i < end; ++i)
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
