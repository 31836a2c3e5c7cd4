// One invocation per pair of children that a round made: places both children. The rounds run from the last to the
// first, so parents come before their children.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/layout.glsl"
layout(location = LOCATION_ROUND_INDEX) uniform uint round_index;
layout(location = LOCATION_MESH_COUNT) uniform uint mesh_count;
layout(std430, binding = BINDING_ROUNDS) readonly buffer Rounds { uint rounds[]; };
layout(std430, binding = BINDING_PAIRS) readonly buffer Pairs { uvec4 pairs[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= rounds[round_index * ROUND_STRIDE + ROUND_PAIRS])
    return;
  const uint pair = rounds[round_index * ROUND_STRIDE + ROUND_FIRST_PAIR] + i;
  const uint first_pair_node = root_base + mesh_count;
  const uint start = pair_starts[pair];
  const Cluster left = unpackCluster(pairs[PAIR_TEXELS * pair], pairs[PAIR_TEXELS * pair + 1u]);
  const Cluster right =
      unpackCluster(pairs[PAIR_TEXELS * pair + CLUSTER_TEXELS], pairs[PAIR_TEXELS * pair + CLUSTER_TEXELS + 1u]);
  place(left, first_pair_node + 2u * pair, start, first_pair_node);
  place(right, first_pair_node + 2u * pair + 1u, start + left.count, first_pair_node);
}
