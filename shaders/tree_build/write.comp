// One invocation per CHUNK clusters: writes the clusters that remain, packed and in order, and the pairs of children of
// the merged clusters (merge.glsl).
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/cluster.glsl"
#include "tree_build/merge.glsl"
layout(std430, binding = BINDING_CLUSTERS_IN) readonly buffer ClustersIn { uvec4 clusters_in[]; };
// Mesh, cost of a traversal (float bits).
layout(std430, binding = BINDING_CLUSTER_INFO_IN) readonly buffer InfoIn { uvec2 info_in[]; };
layout(std430, binding = BINDING_SUMS) readonly buffer Sums { uvec2 sums[]; };
layout(std430, binding = BINDING_CLUSTERS_OUT) writeonly buffer ClustersOut { uvec4 clusters_out[]; };
layout(std430, binding = BINDING_CLUSTER_INFO_OUT) writeonly buffer InfoOut { uvec2 info_out[]; };
layout(std430, binding = BINDING_PAIRS) writeonly buffer Pairs { uvec4 pairs[]; };  // the two clusters of each pair

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
    uvec4 low = clusters_in[CLUSTER_TEXELS * i];
    uvec4 high = clusters_in[CLUSTER_TEXELS * i + 1u];
    if (fate == MERGES)
    {
      const uint j = nearest[i];
      const uvec4 other_low = clusters_in[CLUSTER_TEXELS * j];
      const uvec4 other_high = clusters_in[CLUSTER_TEXELS * j + 1u];
      pairs[PAIR_TEXELS * at.y] = low;
      pairs[PAIR_TEXELS * at.y + 1u] = high;
      pairs[PAIR_TEXELS * at.y + CLUSTER_TEXELS] = other_low;
      pairs[PAIR_TEXELS * at.y + CLUSTER_TEXELS + 1u] = other_high;
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
    clusters_out[CLUSTER_TEXELS * at.x] = low;
    clusters_out[CLUSTER_TEXELS * at.x + 1u] = high;
    info_out[at.x] = info;
    ++at.x;
  }
}
