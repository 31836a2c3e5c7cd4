// One triangle of a leaf against one of another. PADDED is 1 where some pairs have a required distance: merely to hold the
// code for them halves the speed of all others on llvmpipe.
#include "error_bounds.glsl"
#include "triangles.glsl"
#include "triangle_pair.glsl"
#include "triangle_distance.glsl"

void testTriangles(uint item_index, Item item, uint triangle_a, uint triangle_b)
{
  vec3 a[3];
  vec3 b[3];
  fetchTriangle(triangle_a, a);
  fetchTriangle(triangle_b, b);
  for (int k = 0; k < 3; ++k)
    b[k] = apply(item.pose, b[k]);
  uint found = FLOATS_DECIDE != 0 ? trianglePair(a, b, item.pose.translation, item.error, item.gap) : STATE_UNDECIDED;
#if PADDED && FLOATS_DECIDE
  // Where triangles are not known to meet, their distance may still be too small. A loop: on llvmpipe it costs only those
  // that take it.
  const float distance = fetchDistance(item_index);
  for (bool open = found == STATE_UNDECIDED && distance > 0.0; open; open = false)
    found = triangleDistance(a, b, item.error, distance, item.gap);
#endif
  if (found != 0u)
    report(item.state, item.pair, found);
}

// Triangle `i` of the smaller one of two leaves against the larger one.
void testLeafRow(uvec4 pair, uint i)
{
  const Item item = fetchItem(pair.x);
  const uint first_a = leafFirst(pair.y);
  const uint first_b = leafFirst(pair.z);
  const uint count_a = leafCount(pair.y);
  const uint count_b = leafCount(pair.z);
  const bool a_is_smaller = count_a <= count_b;
  const uint count = max(count_a, count_b);
  for (uint j = 0u; j < count; ++j)
    testTriangles(pair.x, item, first_a + (a_is_smaller ? i : j), first_b + (a_is_smaller ? j : i));
}
