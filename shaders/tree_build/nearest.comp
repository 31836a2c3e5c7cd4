// One invocation per cluster: finds the neighbour within SEARCH_RADIUS places for which the union of both boxes has the
// smallest surface (Meister and Bittner 2018, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
// Construction"). A tie goes to the neighbour whose index differs in the lowest bits, so that equal boxes form pairs
// and not chains. In the forced rounds, neighbours form pairs by parity, which bounds the depth.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/cluster.glsl"
layout(location = LOCATION_ROUND_INDEX) uniform uint round_index;
layout(binding = UNIT_CLUSTERS) uniform usamplerBuffer clusters;
layout(std430, binding = BINDING_CLUSTER_INFO_IN) readonly buffer ClusterInfo { uvec2 cluster_info[]; };
layout(std430, binding = BINDING_ROUNDS) readonly buffer Rounds { uint rounds[]; };
layout(std430, binding = BINDING_NEAREST) writeonly buffer Nearest { uint nearest[]; };

vec3 lowOf(uint cluster)
{
  return uintBitsToFloat(texelFetch(clusters, int(CLUSTER_TEXELS * cluster)).xyz);
}

vec3 highOf(uint cluster)
{
  return uintBitsToFloat(texelFetch(clusters, int(CLUSTER_TEXELS * cluster + 1u)).xyz);
}

void main()
{
  const uint i = invocationIndex();
  const uint cluster_count = rounds[round_index * ROUND_STRIDE + ROUND_CLUSTERS];
  if (i >= cluster_count)
    return;
  const uint mesh = cluster_info[i].x;
  if (round_index >= NEAREST_ROUNDS)
  {
    const uint partner = ((i + round_index) & 1u) == 0u ? i + 1u : i - 1u;  // 0 - 1 wraps and is out of range
    nearest[i] = partner < cluster_count && cluster_info[partner].x == mesh ? partner : i;
    return;
  }
  const vec3 low = lowOf(i);
  const vec3 high = highOf(i);
  // The clusters of a mesh follow each other.
  uint begin = i < SEARCH_RADIUS ? 0u : i - SEARCH_RADIUS;
  while (cluster_info[begin].x != mesh)
    ++begin;
  uint end = min(i + SEARCH_RADIUS + 1u, cluster_count);
  while (cluster_info[end - 1u].x != mesh)
    --end;
  uint best = i;
  float best_area = 3.4e38;
  for (uint j = begin; j < end; ++j)
  {
    const vec3 union_low = min(low, lowOf(j));
    const vec3 union_high = max(high, highOf(j));
    const float area = halfArea(union_high - union_low);
    const bool better = best == i || area < best_area || (area == best_area && (i ^ j) < (i ^ best));
    if (j != i && better)
    {
      best = j;
      best_area = area;
    }
  }
  nearest[i] = best;
}
