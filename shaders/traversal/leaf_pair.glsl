// Tests one triangle of a leaf against one triangle of another leaf. PADDED is 1 if some pairs have a required
// distance. On llvmpipe, the code for them halves the speed of all other pairs even if it does not run.
#include "geometry/error_bounds.glsl"
#include "problem/triangles.glsl"
#include "geometry/triangle_pair.glsl"
#include "geometry/triangle_distance.glsl"

void testTriangles(uint root_pair_index, RootPair root_pair, uint triangle_a, uint triangle_b)
{
  vec3 a[3];
  vec3 b[3];
  fetchTriangle(triangle_a, a);
  fetchTriangle(triangle_b, b);
  for (int k = 0; k < 3; ++k)
    b[k] = apply(root_pair.pose, b[k]);
  uint found = FLOAT32_TRUSTED != 0 ? trianglePair(a, b, root_pair.pose.translation, root_pair.error, root_pair.gap)
                                    : STATE_UNDECIDED;
#if PADDED && FLOAT32_TRUSTED
  // The distance of triangles that are not proven to meet may still be too small. The loop runs at most once. It stands
  // for a branch: on llvmpipe, a branch costs all invocations time, but a loop only those that enter it.
  const float distance = fetchDistance(root_pair_index);
  for (bool open = found == STATE_UNDECIDED && distance > 0.0; open; open = false)
    found = triangleDistance(a, b, root_pair.error, distance, root_pair.gap);
#endif
  if (found != 0u)
    report(root_pair.state, root_pair.pair, found);
}

// Tests triangle `i` of the smaller one of two leaves against all triangles of the larger one.
void testLeafRow(uvec4 pair, uint i)
{
  const RootPair root_pair = fetchRootPair(pair.x);
  const uint first_a = leafFirst(pair.y);
  const uint first_b = leafFirst(pair.z);
  const uint count_a = leafCount(pair.y);
  const uint count_b = leafCount(pair.z);
  const bool a_is_smaller = count_a <= count_b;
  const uint count = max(count_a, count_b);
  for (uint j = 0u; j < count; ++j)
    testTriangles(pair.x, root_pair, first_a + (a_is_smaller ? i : j), first_b + (a_is_smaller ? j : i));
}
