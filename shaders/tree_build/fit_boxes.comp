// One invocation per node: fits its oriented box (fit.glsl). Nodes of more than FIT_INVOCATION_TRIANGLES triangles are
// listed for fit_large_boxes.comp. Nodes of more than FIT_MAX_TRIANGLES keep their axis-aligned box. This bounds the
// work and costs little, because only the topmost nodes of few trees are that large.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "problem/nodes.glsl"
#include "problem/triangles.glsl"
#include "tree_build/fit_output.glsl"
#include "tree_build/fit.glsl"
layout(location = LOCATION_FIRST_NODE) uniform uint first_node;
layout(location = LOCATION_NODE_COUNT) uniform uint node_count;
// For each listed node, its place, its first triangle and its number of triangles.
layout(std430, binding = BINDING_LARGE_NODES) buffer LargeNodes { uvec4 large_nodes[]; };
layout(std430, binding = BINDING_LARGE_COUNT) buffer LargeCount { uint large_count; };

// The first triangle below a node, and the number of triangles below it. The triangles of a subtree are contiguous.
uvec2 trianglesBelow(TreeNode node)
{
  TreeNode left = node;
  while (left.count == 0u)
    left = fetchNode(left.first);
  TreeNode right = node;
  while (right.count == 0u)
    right = fetchNode(right.first + 1u);
  return uvec2(left.first, right.first + right.count - left.first);
}

void main()
{
  const uint i = invocationIndex();
  if (i >= node_count)
    return;
  const TreeNode node = fetchNode(first_node + i);
  const uvec2 below = trianglesBelow(node);
  if (below.y > FIT_INVOCATION_TRIANGLES)
  {
    if (below.y <= FIT_MAX_TRIANGLES)
      large_nodes[atomicAdd(large_count, 1u)] = uvec4(first_node + i, below, 0u);
    else
      writeOriented(first_node + i, node, node.box.center, node.box.extent, vec4(0.0, 0.0, 0.0, 1.0));
    return;
  }
  vec3 corners[3];
  Spread spread = emptySpread(below.x);
  for (uint k = below.x; k < below.x + below.y; ++k)
  {
    fetchAround(k, node.box.center, corners);
    add(spread, corners, k);
  }
  vec4 axes[FIT_BOXES];
  chooseAxes(spread, below.y, node.box.center, axes);
  mat3 rotations[FIT_BOXES];
  for (int box = 0; box < FIT_BOXES; ++box)
    rotations[box] = rotationOf(axes[box]);
  Extents extents = emptyExtents();
  for (uint k = below.x; k < below.x + below.y; ++k)
  {
    fetchAround(k, node.box.center, corners);
    extend(extents, corners, rotations);
  }
  writeBest(first_node + i, node, extents, axes);
}
