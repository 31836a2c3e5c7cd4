#include "base/sine.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <boost/multiprecision/cpp_bin_float.hpp>

namespace gpu_planning_scene::core
{
namespace
{
using Precise = boost::multiprecision::cpp_bin_float_50;

void expectRight(double x)
{
  const auto [sine, cosine] = sineCosine(x);
  const Precise true_sine = sin(Precise(x));
  const Precise true_cosine = cos(Precise(x));
  const auto bound = [](const Precise& value)
  {
    const double size = std::abs(static_cast<double>(value));
    return 0.8 * (std::nextafter(size, 2.0) - size) + 1e-20;
  };
  EXPECT_LE(std::abs(static_cast<double>(true_sine - sine)), bound(true_sine)) << "sine of " << x;
  EXPECT_LE(std::abs(static_cast<double>(true_cosine - cosine)), bound(true_cosine)) << "cosine of " << x;
}

TEST(Sine, IsRightToTheLastPlaceForSmallAndLargeAngles)
{
  const std::uint64_t seed = 21;
  std::mt19937_64 generator(seed);
  for (const double reach : {1e-9, 1e-3, 0.8, 3.2, 7.0, 1e3, 1048576.0})
  {
    std::uniform_real_distribution<double> angle(-reach, reach);
    for (int i = 0; i < 1000; ++i)
      expectRight(angle(generator));
    expectRight(reach);
  }
}

TEST(Sine, IsRightNextToMultiplesOfAQuarterTurn)
{
  for (const int quadrants : {0, 1, 2, 3, 4, 5, -1, -2, 12345, 500001, 667543})
  {
    const double x = quadrants * 0.5 * 3.141592653589793;
    for (const double next : {x, std::nextafter(x, 1e9), std::nextafter(x, -1e9), x + 1e-8, x - 1e-8})
      expectRight(next);
  }
}

TEST(Sine, BeyondItsRangeIsTheLibrarys)
{
  for (const double x : {1048577.0, -3e7, 1e300})
  {
    EXPECT_EQ(std::sin(x), sineCosine(x).sine);
    EXPECT_EQ(std::cos(x), sineCosine(x).cosine);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
