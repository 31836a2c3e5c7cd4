// One invocation per mesh: places the root of its tree. The clusters that are left at the end are the roots.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/layout.glsl"
layout(location = LOCATION_MESH_COUNT) uniform uint mesh_count;
layout(std430, binding = BINDING_CLUSTERS_EVEN) readonly buffer EvenClusters { uvec4 even_clusters[]; };
layout(std430, binding = BINDING_CLUSTERS_ODD) readonly buffer OddClusters { uvec4 odd_clusters[]; };
layout(std430, binding = BINDING_ROUNDS) readonly buffer Rounds { uint rounds[]; };
layout(std430, binding = BINDING_FIRST_PRIMITIVE) readonly buffer FirstTriangle { uint first_triangle[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= mesh_count)
    return;
  const bool odd = rounds[BUILD_ROUNDS * ROUND_STRIDE + ROUND_PAIRS] != 0u;
  const uvec4 low = odd ? odd_clusters[CLUSTER_TEXELS * i] : even_clusters[CLUSTER_TEXELS * i];
  const uvec4 high = odd ? odd_clusters[CLUSTER_TEXELS * i + 1u] : even_clusters[CLUSTER_TEXELS * i + 1u];
  place(unpackCluster(low, high), root_base + i, first_triangle[i], root_base + mesh_count);
}
