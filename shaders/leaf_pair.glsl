// Triangles of one leaf against triangles of another.
#include "triangle_pair.glsl"
layout(binding = UNIT_TRIANGLES) uniform usamplerBuffer triangle_texels;

void fetchTriangle(uint index, out vec3 corners[3])
{
  for (int i = 0; i < 3; ++i)
    corners[i] = uintBitsToFloat(texelFetch(triangle_texels, int(3u * index) + i).xyz);
}

// A leaf in one word: its first triangle, and how many less one.
uint leafReference(TreeNode leaf)
{
  return leaf.first | ((leaf.count - 1u) << LEAF_COUNT_SHIFT);
}

// Triangle number `i` of leaf a, if there is one, against all of leaf b.
void testLeafTriangle(uint item_index, uint i, uint leaf_a, uint leaf_b)
{
  const uint mask = (1u << LEAF_COUNT_SHIFT) - 1u;
  const uint last_a = leaf_a >> LEAF_COUNT_SHIFT;
  const uint last_b = leaf_b >> LEAF_COUNT_SHIFT;
  const Item item = fetchItem(item_index);
  vec3 a[3];
  fetchTriangle((leaf_a & mask) + min(i, last_a), a);
  uint found = 0u;
  for (uint j = 0u; j < uint(LEAF_TRIANGLES); ++j)
  {
    vec3 b[3];
    fetchTriangle((leaf_b & mask) + min(j, last_b), b);
    for (int k = 0; k < 3; ++k)
      b[k] = apply(item.pose, b[k]);
    found |= trianglePair(a, b, item.error, item.slack);
  }
  if (i <= last_a && found != 0u)
    report(item.state, item.pair, found);
}
