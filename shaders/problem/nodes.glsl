// Nodes and their boxes.
struct Box
{
  vec3 center;
  vec3 extent;  // half edge lengths
};

struct TreeNode
{
  Box box;
  uint first;  // inner node: its children are first and first + 1; leaf: its first triangle
  uint count;  // 0: inner node
};

layout(binding = UNIT_NODES) uniform usamplerBuffer node_texels;

TreeNode fetchNode(uint index)
{
  const uvec4 a = texelFetch(node_texels, int(2u * index));
  const uvec4 b = texelFetch(node_texels, int(2u * index + 1u));
  return TreeNode(Box(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz)), a.w, b.w);
}

// A leaf in one word: its first triangle, and how many less one.
uint leafReference(uint first, uint count)
{
  return first | ((count - 1u) << LEAF_COUNT_SHIFT);
}

uint leafFirst(uint leaf)
{
  return leaf & ((1u << LEAF_COUNT_SHIFT) - 1u);
}

uint leafCount(uint leaf)
{
  return (leaf >> LEAF_COUNT_SHIFT) + 1u;
}

// A solid stands in a tree of its own: one leaf, whose first triangle is this bit and the instance.
bool isSolidLeaf(uint leaf)
{
  return (leaf & SOLID_LEAF) != 0u;
}
