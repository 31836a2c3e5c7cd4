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

void fetchMovedTriangle(uint index, Pose pose, out vec3 corners[3])
{
  fetchTriangle(index, corners);
  for (int k = 0; k < 3; ++k)
    corners[k] = apply(pose, corners[k]);
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
  uint open = 0u;  // bit j: triangle j of leaf b is undecided
  for (uint j = 0u; j < uint(LEAF_TRIANGLES); ++j)
  {
    vec3 b[3];
    fetchMovedTriangle((leaf_b & mask) + min(j, last_b), item.pose, b);
    const uint pair = FLOATS_DECIDE != 0 ? trianglePair(a, b, item.pose.translation, item.error, item.gap) : STATE_UNDECIDED;
    found |= pair;
    open |= pair == STATE_UNDECIDED ? 1u << j : 0u;
  }
#if PADDED && FLOATS_DECIDE
  // Where triangles are not known to meet, their distance may still be too small. A loop of its own: on llvmpipe it costs
  // only those that take it.
  const float distance = fetchDistance(item_index);
  if (distance > 0.0)
    found &= STATE_HIT;
  open = distance > 0.0 && i <= last_a && found == 0u ? open & ((2u << last_b) - 1u) : 0u;
  for (; open != 0u; open &= open - 1u)
  {
    vec3 b[3];
    fetchMovedTriangle((leaf_b & mask) + uint(findLSB(open)), item.pose, b);
    found |= triangleDistance(a, b, item.error, distance, item.gap);
  }
#endif
  if (i <= last_a && found != 0u)
    report(item.state, item.pair, found);
}
