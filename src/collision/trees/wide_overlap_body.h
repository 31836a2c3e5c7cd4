// The source of the overlap test of wide trees, included once for each instruction set, see wide_overlap.h.
#ifndef GPS_OVERLAP_TEST
#error "define the test's name before this file is included"
#endif

#include "collision/geometry/eight_boxes.h"

namespace gpu_planning_scene::core
{
unsigned GPS_OVERLAP_TEST(const WideNode& node, const FloatBox& box);

unsigned GPS_OVERLAP_TEST(const WideNode& node, const FloatBox& box)
{
  // Prevents nearly parallel edges from separating boxes because of rounding, see docs/error_bounds.md.
  constexpr float kParallel = 64.0F * 5.9604645e-8F;  // 64 times 2^-24

  const int present = (1 << node.boxes) - 1;
  const Floats between[3] = {box.center[0] - load(node.center[0]), box.center[1] - load(node.center[1]),
                             box.center[2] - load(node.center[2])};
  const Floats a[3] = {load(node.half[0]), load(node.half[1]), load(node.half[2])};
  const float* b = box.half;
  EightBoxPairs pairs;
  for (int i = 0; i < 3; ++i)
  {
    const Floats x = load(node.axes[i][0]);
    const Floats y = load(node.axes[i][1]);
    const Floats z = load(node.axes[i][2]);
    for (int j = 0; j < 3; ++j)
    {
      pairs.axes[i][j] = x * box.axes[j][0] + y * box.axes[j][1] + z * box.axes[j][2];
      pairs.magnitudes[i][j] = magnitude(pairs.axes[i][j]) + kParallel;
    }
    pairs.between[i] = x * between[0] + y * between[1] + z * between[2];
  }
  Ints apart = pairs.apartByFaces(a, b);
  if (box.has_long_distance)
  {
    const float d = box.distance;
    const float bare[3] = {b[0] - d, b[1] - d, b[2] - d};
    const Floats* t = pairs.between;
    const auto& m = pairs.magnitudes;
    for (int i = 0; i < 3; ++i)
      apart |= magnitude(t[i]) > a[i] + m[i][0] * bare[0] + m[i][1] * bare[1] + m[i][2] * bare[2] + d;
    const Floats squared = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
    const Floats reach_a = a[0] * magnitude(t[0]) + a[1] * magnitude(t[1]) + a[2] * magnitude(t[2]);
    const Floats reach_b =
        bare[0] * magnitude(pairs.along(0)) + bare[1] * magnitude(pairs.along(1)) + bare[2] * magnitude(pairs.along(2));
    apart |= squared - (reach_a + reach_b) > d * squareRoot(squared);
  }
  // A comparison with NaN is false, so a box with NaN counts as overlapping.
  int kept = ~bits(apart) & present;
  if (kept == 0)
    return 0;
  kept &= ~bits(pairs.apartByEdges(a, b));
  return static_cast<unsigned>(kept);
}
}  // namespace gpu_planning_scene::core
