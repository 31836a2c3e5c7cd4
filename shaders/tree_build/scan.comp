// One work group: computes the exclusive prefix sums of a round's counts, the number of pairs that the round makes, and
// the next round's record. When each mesh has only one cluster left, the following rounds get zero work groups.
#include "shader_constants.h"
layout(local_size_x = SCAN_INVOCATIONS) in;
#include "common/invocation.glsl"
layout(location = LOCATION_ROUND_INDEX) uniform uint round_index;
layout(location = LOCATION_MESH_COUNT) uniform uint mesh_count;
layout(std430, binding = BINDING_ROUNDS) buffer Rounds { uint rounds[]; };
layout(std430, binding = BINDING_SUMS) buffer Sums { uvec2 sums[]; };

#define SCAN_TYPE uvec2
#define SCAN_VALUES sums
#include "common/prefix_sum.glsl"

void setGroups(uint at, uint invocations)
{
  const uint groups = (invocations + GROUP_SIZE - 1u) / GROUP_SIZE;
  const uint rows = (groups + MAX_GROUPS - 1u) / MAX_GROUPS;
  rounds[at] = rows == 0u ? 0u : (groups + rows - 1u) / rows;
  rounds[at + 1u] = rows;
  rounds[at + 2u] = 1u;
}

void main()
{
  const uint now = round_index * ROUND_STRIDE;
  const uint next = now + ROUND_STRIDE;
  const uint cluster_count = rounds[now + ROUND_CLUSTERS];
  const bool done = cluster_count == mesh_count;
  const uvec2 total = scanInPlace(done ? 0u : (cluster_count + CHUNK - 1u) / CHUNK);
  if (gl_LocalInvocationID.x == 0u)
  {
    const uint remaining = done ? cluster_count : total.x;
    rounds[now + ROUND_PAIRS] = total.y;
    setGroups(now + ROUND_PAIR_GROUPS, total.y);
    rounds[next + ROUND_CLUSTERS] = remaining;
    rounds[next + ROUND_FIRST_PAIR] = rounds[now + ROUND_FIRST_PAIR] + total.y;
    const uint invocations = remaining == mesh_count ? 0u : remaining;
    setGroups(next + ROUND_CLUSTER_GROUPS, invocations);
    setGroups(next + ROUND_CHUNK_GROUPS, (invocations + CHUNK - 1u) / CHUNK);
    // In the last round that merges clusters, the remaining clusters are the roots. The record keeps the buffer to
    // which this round writes them: 1 for the odd clusters (layout_roots.comp).
    if (!done && remaining == mesh_count)
      rounds[BUILD_ROUNDS * ROUND_STRIDE + ROUND_PAIRS] = (round_index + 1u) & 1u;
  }
}
