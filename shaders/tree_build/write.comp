// One invocation per CHUNK clusters: writes the clusters that remain, packed and in order, and the pairs of children of
// the merged clusters (merge.glsl).
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/cluster.glsl"
#include "tree_build/merge.glsl"
layout(std430, binding = 0) readonly buffer ClustersIn { uvec4 clusters_in[]; };
layout(std430, binding = 1) readonly buffer InfoIn { uvec2 info_in[]; };  // mesh, cost of a traversal (float bits)
layout(std430, binding = 4) readonly buffer Sums { uvec2 sums[]; };
layout(std430, binding = 5) writeonly buffer ClustersOut { uvec4 clusters_out[]; };
layout(std430, binding = 6) writeonly buffer InfoOut { uvec2 info_out[]; };
layout(std430, binding = 7) writeonly buffer Pairs { uvec4 pairs[]; };  // four a pair: its two clusters

void main()
{
  const uint invocation = invocationIndex();
  const uint cluster_count = rounds[round_index * ROUND_STRIDE + ROUND_CLUSTERS];
  if (invocation * CHUNK >= cluster_count)
    return;
  uvec2 at = sums[invocation];
  at.y += rounds[round_index * ROUND_STRIDE + ROUND_FIRST_PAIR];
  const uint end = min((invocation + 1u) * CHUNK, cluster_count);
  for (uint i = invocation * CHUNK; i < end; ++i)
  {
    const uint fate = fateOf(i);
    if (fate == VANISHES)
      continue;
    uvec2 info = info_in[i];
    uvec4 low = clusters_in[2u * i];
    uvec4 high = clusters_in[2u * i + 1u];
    if (fate == MERGES)
    {
      const uint j = nearest[i];
      const uvec4 other_low = clusters_in[2u * j];
      const uvec4 other_high = clusters_in[2u * j + 1u];
      pairs[4u * at.y] = low;
      pairs[4u * at.y + 1u] = high;
      pairs[4u * at.y + 2u] = other_low;
      pairs[4u * at.y + 3u] = other_high;
      const Cluster a = unpackCluster(low, high);
      const Cluster b = unpackCluster(other_low, other_high);
      Cluster merged = Cluster(min(a.low, b.low), max(a.high, b.high), at.y, a.count + b.count, false);
      // The surface area heuristic decides whether a few triangles form a leaf (J. D. MacDonald, K. S. Booth:
      // Heuristics for ray tracing using space subdivision, 1990).
      const float area = halfArea(merged.high - merged.low);
      const float closed_cost = TRIANGLE_COST * float(merged.count) * area;
      const float opened_cost = area + uintBitsToFloat(info.y) + uintBitsToFloat(info_in[j].y);
      merged.opened = opened_cost < closed_cost;
      info.y = floatBitsToUint(merged.opened ? opened_cost : closed_cost);
      low = packLow(merged);
      high = packHigh(merged);
      ++at.y;
    }
    clusters_out[2u * at.x] = low;
    clusters_out[2u * at.x + 1u] = high;
    info_out[at.x] = info;
    ++at.x;
  }
}
