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
uint leafReference(TreeNode leaf)
{
  return leaf.first | ((leaf.count - 1u) << LEAF_COUNT_SHIFT);
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

// Whether box b, placed by `pose` in a's frame, is apart from box a by more than `margin` along one of the 15 axes that
// can separate two boxes (Gottschalk, Lin and Manocha 1996, "OBBTree"). `false` proves nothing. The axes that are
// products of edges are at most 1 long, so that the margin holds for them a fortiori.
bool boxesApart(Box a, Box b, Pose pose, float margin)
{
  const mat3 r = pose.rotation;  // r[j] is b's axis j in a's frame
  const vec3 t = apply(pose, b.center) - a.center;
  const mat3 q = mat3(abs(r[0]), abs(r[1]), abs(r[2]));
  const vec3 ea = a.extent;
  const vec3 eb = b.extent;
  const vec3 tb = t * r;  // along b's axes
  const vec3 gap_a = abs(t) - (ea + q * eb);
  const vec3 gap_b = abs(tb) - (eb + ea * q);
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
  return gap > margin;
}

// Whether a node's box lies within the core of the other tree's solid by more than `margin`: then what it holds is inside.
// A core that is not there has negative extents, and nothing lies within it.
bool boxInCore(Box a, Box b, vec3 core_a, vec3 core_b, Pose pose, float margin)
{
  const mat3 r = pose.rotation;
  const mat3 q = mat3(abs(r[0]), abs(r[1]), abs(r[2]));
  const vec3 b_in_a = abs(apply(pose, b.center)) + q * b.extent + margin;
  const vec3 a_in_b = abs((a.center - pose.translation) * r) + a.extent * q + margin;
  return all(lessThan(b_in_a, core_a)) || all(lessThan(a_in_b, core_b));
}

// The size that decides which of two nodes is taken apart first.
float boxSize(Box box)
{
  return dot(box.extent, box.extent);
}
