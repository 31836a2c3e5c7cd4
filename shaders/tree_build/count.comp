// One invocation per CHUNK clusters: counts the clusters that remain after the round's merges (merge.glsl), and the
// merges.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/merge.glsl"
layout(std430, binding = BINDING_SUMS) writeonly buffer Sums { uvec2 sums[]; };  // clusters that remain, merges

void main()
{
  const uint invocation = invocationIndex();
  const uint cluster_count = rounds[round_index * ROUND_STRIDE + ROUND_CLUSTERS];
  if (invocation * CHUNK >= cluster_count)
    return;
  uvec2 sum = uvec2(0u);
  const uint end = min((invocation + 1u) * CHUNK, cluster_count);
  for (uint i = invocation * CHUNK; i < end; ++i)
  {
    const uint fate = fateOf(i);
    sum += uvec2(fate == VANISHES ? 0u : 1u, fate == MERGES ? 1u : 0u);
  }
  sums[invocation] = sum;
}
