// Argument reduction with pi / 2 in three parts, after Cody and Waite, "Software Manual for the Elementary Functions"
// (1980), then Taylor series.
#include "model/sine.h"

#include <cmath>

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kLargest = 1048576.0;  // 2^20

// pi / 2 = kPart1 + kPart2 + kPart3 + about 1e-36. The first two have 32 bits or fewer: their products with the number
// of quadrants, which has at most 20, are exact.
constexpr double kPart1 = 0x1.921fb544p+0;
constexpr double kPart2 = 0x1.0b4611a6p-34;
constexpr double kPart3 = 0x1.3198a2e037073p-69;
constexpr double kQuadrantsPerRadian = 0x1.45f306dc9c883p-1;  // 2 / pi

// The first term that is left out is below 1e-19 of the result on [-pi / 4, pi / 4].
// `tail` is what x + tail is more than x.
double sineNearZero(double x, double tail)
{
  const double z = x * x;
  double sum = 1.0 / 355687428096000.0;  // 1 / 17!
  sum = sum * z - 1.0 / 1307674368000.0;
  sum = sum * z + 1.0 / 6227020800.0;
  sum = sum * z - 1.0 / 39916800.0;
  sum = sum * z + 1.0 / 362880.0;
  sum = sum * z - 1.0 / 5040.0;
  sum = sum * z + 1.0 / 120.0;
  sum = sum * z - 1.0 / 6.0;
  return x + (x * z * sum + tail * (1.0 - 0.5 * z));
}

double cosineNearZero(double x, double tail)
{
  const double z = x * x;
  double sum = -1.0 / 6402373705728000.0;  // -1 / 18!
  sum = sum * z + 1.0 / 20922789888000.0;
  sum = sum * z - 1.0 / 87178291200.0;
  sum = sum * z + 1.0 / 479001600.0;
  sum = sum * z - 1.0 / 3628800.0;
  sum = sum * z + 1.0 / 40320.0;
  sum = sum * z - 1.0 / 720.0;
  sum = sum * z + 1.0 / 24.0;
  // 1 - z / 2 with what its rounding loses.
  const double half = 0.5 * z;
  const double start = 1.0 - half;
  return start + (((1.0 - start) - half) + (z * z * sum - x * tail));
}
}  // namespace

SineCosine sineCosine(double x)
{
  if (!(std::abs(x) <= kLargest))
    return {std::sin(x), std::cos(x)};
  const double quadrants = std::nearbyint(x * kQuadrantsPerRadian);
  // The first difference is exact: both are multiples of the last place of kPart1 * quadrants or of x, and near.
  const double first = x - quadrants * kPart1;
  const double second = quadrants * kPart2;
  const double third = quadrants * kPart3;
  const double rough = first - second;
  const double lost = (first - rough) - second;  // exact where |first| >= |second|, else off by 1e-20 at most
  const double reduced = rough + (lost - third);
  const double tail = (rough - reduced) + (lost - third);
  const double sine = sineNearZero(reduced, tail);
  const double cosine = cosineNearZero(reduced, tail);
  switch (static_cast<long>(quadrants) & 3)
  {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}
}  // namespace gpu_planning_scene::core
