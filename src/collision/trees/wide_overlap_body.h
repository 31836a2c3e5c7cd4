// The source of the overlap test of wide trees, included once for each instruction set, see wide_overlap.h.
#ifndef GPS_OVERLAP_TEST
#error "define the test's name before this file is included"
#endif

#include "collision/geometry/eight_floats.h"

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
  Floats r[3][3];  // the axes of `box` in the frames of the node's boxes
  Floats abs_r[3][3];
  Floats t[3];
  Ints apart = {};
  for (int i = 0; i < 3; ++i)
  {
    const Floats x = load(node.axes[i][0]);
    const Floats y = load(node.axes[i][1]);
    const Floats z = load(node.axes[i][2]);
    for (int j = 0; j < 3; ++j)
    {
      r[i][j] = x * box.axes[j][0] + y * box.axes[j][1] + z * box.axes[j][2];
      abs_r[i][j] = magnitude(r[i][j]) + kParallel;
    }
    t[i] = x * between[0] + y * between[1] + z * between[2];
    apart |= magnitude(t[i]) > a[i] + abs_r[i][0] * b[0] + abs_r[i][1] * b[1] + abs_r[i][2] * b[2];
  }
  Floats along[3];  // the vector between the centres along the axes of `box`
  for (int j = 0; j < 3; ++j)
  {
    along[j] = magnitude(t[0] * r[0][j] + t[1] * r[1][j] + t[2] * r[2][j]);
    apart |= along[j] > a[0] * abs_r[0][j] + a[1] * abs_r[1][j] + a[2] * abs_r[2][j] + b[j];
  }
  if (box.has_long_distance)
  {
    const float d = box.distance;
    const float bare[3] = {b[0] - d, b[1] - d, b[2] - d};
    for (int i = 0; i < 3; ++i)
      apart |= magnitude(t[i]) > a[i] + abs_r[i][0] * bare[0] + abs_r[i][1] * bare[1] + abs_r[i][2] * bare[2] + d;
    const Floats squared = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
    const Floats reach_a = a[0] * magnitude(t[0]) + a[1] * magnitude(t[1]) + a[2] * magnitude(t[2]);
    const Floats reach_b = bare[0] * along[0] + bare[1] * along[1] + bare[2] * along[2];
    apart |= squared - (reach_a + reach_b) > d * squareRoot(squared);
  }
  // A comparison with NaN is false, so a box with NaN counts as overlapping.
  int kept = ~bits(apart) & present;
  if (kept == 0)
    return 0;
  for (int i = 0; i < 3; ++i)
  {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j)
    {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      apart |= magnitude(t[i2] * r[i1][j] - t[i1] * r[i2][j]) >
               a[i1] * abs_r[i2][j] + a[i2] * abs_r[i1][j] + b[j1] * abs_r[i][j2] + b[j2] * abs_r[i][j1];
    }
  }
  kept &= ~bits(apart);
  return static_cast<unsigned>(kept);
}
}  // namespace gpu_planning_scene::core
