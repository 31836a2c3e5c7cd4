#include "base/sine.h"

#include <cmath>

#include "base/strict_arithmetic.h"

// The argument is reduced with pi / 2 in three parts, after W. J. Cody, W. Waite: Software Manual for the Elementary
// Functions (1980). Taylor series then give the sine and the cosine.
namespace gpu_planning_scene::core
{
namespace
{
constexpr double kLargest = 1048576.0;  // 2^20

// pi / 2 = kPart1 + kPart2 + kPart3 + about 1e-36. kPart1 and kPart2 have at most 32 bits, the number of quadrants at
// most 20, so their products are exact.
constexpr double kPart1 = 0x1.921fb544p+0;
constexpr double kPart2 = 0x1.0b4611a6p-34;
constexpr double kPart3 = 0x1.3198a2e037073p-69;
constexpr double kQuadrantsPerRadian = 0x1.45f306dc9c883p-1;  // 2 / pi

// Sine of x + tail. The first omitted term of the series is below 1e-19 of the result on [-pi / 4, pi / 4].
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
  // 1 - z / 2, with the rounding error of that difference added.
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
  // This difference is exact: both numbers are multiples of the last place of one of them, and they are close.
  const double first = x - quadrants * kPart1;
  const double second = quadrants * kPart2;
  const double third = quadrants * kPart3;
  const double rough = first - second;
  const double lost = (first - rough) - second;  // exact if |first| >= |second|, else wrong by at most 1e-20
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
