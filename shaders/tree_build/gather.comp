// One invocation per sorted key: writes the first clusters, one per primitive, in Morton order.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/cluster.glsl"
layout(location = LOCATION_PRIMITIVE_COUNT) uniform uint primitive_count;
layout(std430, binding = BINDING_KEYS_IN) readonly buffer Keys { uvec2 keys[]; };
layout(std430, binding = BINDING_MESH_OF) readonly buffer MeshOf { uint mesh_of[]; };
layout(std430, binding = BINDING_BOXES) readonly buffer Boxes { uvec4 boxes[]; };
layout(std430, binding = BINDING_CLUSTERS_OUT) writeonly buffer Clusters { uvec4 clusters[]; };
// For each cluster, its mesh and the cost of a traversal (float bits).
layout(std430, binding = BINDING_CLUSTER_INFO_OUT) writeonly buffer ClusterInfo { uvec2 cluster_info[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= primitive_count)
    return;
  const uint primitive = keys[i].y;
  clusters[CLUSTER_TEXELS * i] = boxes[CLUSTER_TEXELS * primitive];
  clusters[CLUSTER_TEXELS * i + 1u] = boxes[CLUSTER_TEXELS * primitive + 1u];
  const Cluster box = unpackCluster(boxes[CLUSTER_TEXELS * primitive], boxes[CLUSTER_TEXELS * primitive + 1u]);
  cluster_info[i] = uvec2(mesh_of[primitive], floatBitsToUint(TRIANGLE_COST * halfArea(box.high - box.low)));
}
