// One invocation per sorted key: writes the first clusters, one per primitive, in Morton order.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/cluster.glsl"
layout(location = LOCATION_PRIMITIVE_COUNT) uniform uint primitive_count;
layout(std430, binding = 0) readonly buffer Keys { uvec2 keys[]; };
layout(std430, binding = 1) readonly buffer MeshOf { uint mesh_of[]; };
layout(std430, binding = 2) readonly buffer Boxes { uvec4 boxes[]; };
layout(std430, binding = 3) writeonly buffer Clusters { uvec4 clusters[]; };
// For each cluster, its mesh and the cost of a traversal (float bits).
layout(std430, binding = 4) writeonly buffer ClusterInfo { uvec2 cluster_info[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= primitive_count)
    return;
  const uint primitive = keys[i].y;
  clusters[2u * i] = boxes[2u * primitive];
  clusters[2u * i + 1u] = boxes[2u * primitive + 1u];
  const Cluster box = unpackCluster(boxes[2u * primitive], boxes[2u * primitive + 1u]);
  cluster_info[i] = uvec2(mesh_of[primitive], floatBitsToUint(TRIANGLE_COST * halfArea(box.high - box.low)));
}
