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

// Of a leaf in one word, see leafReference.
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

// How far two boxes are apart along the best of the 15 axes that can separate them (Gottschalk, Lin and Manocha 1996, "OBBTree"):
// half edge lengths, the way from a's centre to b's and b's axes, both in a's frame. Not above 0: it proves nothing. The
// axes that are products of edges are at most 1 long, so that a gap along them is one in metres a fortiori.
float boxGap(vec3 ea, vec3 eb, vec3 t, mat3 r)
{
  const mat3 q = mat3(abs(r[0]), abs(r[1]), abs(r[2]));
  const vec3 gap_a = abs(t) - (ea + q * eb);
  const vec3 gap_b = abs(t * r) - (eb + ea * q);
  float gap = max(max(max(gap_a.x, gap_a.y), gap_a.z), max(max(gap_b.x, gap_b.y), gap_b.z));
  // The axis products x, y, z of a with axis j of b, three at a time.
  for (int j = 0; j < 3; ++j)
  {
    const int k = (j + 1) % 3;
    const int l = (j + 2) % 3;
    const vec3 along = abs(t.zxy * r[j].yzx - t.yzx * r[j].zxy);
    const vec3 reach_a = ea.yzx * q[j].zxy + ea.zxy * q[j].yzx;
    const vec3 reach_b = eb[k] * q[l] + eb[l] * q[k];
    const vec3 gaps = along - (reach_a + reach_b);
    gap = max(gap, max(max(gaps.x, gaps.y), gaps.z));
  }
  return gap;
}
