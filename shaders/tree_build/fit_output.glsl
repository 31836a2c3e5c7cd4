// Writes a node with its fitted box in the layout of traversal/bounding_volume_overlap.glsl.
layout(std430, binding = BINDING_ORIENTED_NODES) writeonly buffer OrientedNodes { uvec4 oriented[]; };

void writeOriented(uint at, TreeNode node, vec3 center, vec3 extent, vec4 axes)
{
  oriented[ORIENTED_NODE_TEXELS * at] = uvec4(floatBitsToUint(center), node.first);
  oriented[ORIENTED_NODE_TEXELS * at + 1u] = uvec4(floatBitsToUint(extent), node.count);
  oriented[ORIENTED_NODE_TEXELS * at + 2u] = floatBitsToUint(axes);
}
