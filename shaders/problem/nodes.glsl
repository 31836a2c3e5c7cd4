// Nodes of the bounding volume trees, with axis-aligned boxes in the frame of the shape (metres).
struct Box
{
  vec3 center;
  vec3 extent;  // half edge lengths
};

struct TreeNode
{
  Box box;
  uint first;  // inner node: the first of its two children, which are adjacent; leaf: its first triangle
  uint count;  // 0: inner node
};

layout(binding = UNIT_NODES) uniform usamplerBuffer node_texels;

TreeNode fetchNode(uint index)
{
  const uvec4 a = texelFetch(node_texels, int(NODE_TEXELS * index));
  const uvec4 b = texelFetch(node_texels, int(NODE_TEXELS * index + 1u));
  return TreeNode(Box(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz)), a.w, b.w);
}

// Packs a leaf into one word: its first triangle, and its number of triangles minus 1 (LEAF_COUNT_SHIFT).
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

// Returns true if the leaf stands for a primitive that is tested as a solid (SOLID_LEAF). This leaf is a tree of its
// own.
bool isSolidLeaf(uint leaf)
{
  return (leaf & SOLID_LEAF) != 0u;
}
