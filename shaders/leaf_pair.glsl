// Triangles of one leaf against triangles of another. PADDED is 1 where some pairs have a required distance: merely to
// hold the code for them halves the speed of all others on llvmpipe.
#include "error_bounds.glsl"
#include "triangles.glsl"
#include "triangle_pair.glsl"
#include "triangle_distance.glsl"

// A leaf in one word: its first triangle, and how many less one.
uint leafReference(TreeNode leaf)
{
  return leaf.first | ((leaf.count - 1u) << LEAF_COUNT_SHIFT);
}

// STATE_* of two triangles of an item.
uint testTriangles(vec3 a[3], vec3 b[3], Item item, float distance)
{
#if FLOATS_DECIDE
  const uint found = trianglePair(a, b, item.error, item.gap);
#if PADDED
  if (found == STATE_UNDECIDED && distance > 0.0)
    return triangleDistance(a, b, item.error, distance, item.gap);
#endif
  return found;
#else
  return STATE_UNDECIDED;
#endif
}

// Triangle number `i` of leaf a, if there is one, against all of leaf b.
void testLeafTriangle(uint item_index, uint i, uint leaf_a, uint leaf_b)
{
  const uint mask = (1u << LEAF_COUNT_SHIFT) - 1u;
  const uint last_a = leaf_a >> LEAF_COUNT_SHIFT;
  const uint last_b = leaf_b >> LEAF_COUNT_SHIFT;
  const Item item = fetchItem(item_index);
  const float distance = fetchDistance(item_index);
  vec3 a[3];
  fetchTriangle((leaf_a & mask) + min(i, last_a), a);
  uint found = 0u;
  for (uint j = 0u; j < uint(LEAF_TRIANGLES); ++j)
  {
    vec3 b[3];
    fetchTriangle((leaf_b & mask) + min(j, last_b), b);
    for (int k = 0; k < 3; ++k)
      b[k] = apply(item.pose, b[k]);
    found |= testTriangles(a, b, item, distance);
  }
  if (i <= last_a && found != 0u)
    report(item.state, item.pair, found);
}
