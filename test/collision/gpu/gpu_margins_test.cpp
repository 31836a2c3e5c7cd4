// Margins are rounded up on their way to the device: a smaller margin could prove a colliding motion free.

#include "collision/gpu/problem/gpu_margins.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace gpu_planning_scene::core
{
namespace
{
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(UploadedMargins, AreTheNextFloatsThatAreNotSmaller)
{
  EXPECT_EQ(0.0F, uploadedMargin(0.0));
  EXPECT_EQ(0.5F, uploadedMargin(0.5));
  constexpr unsigned kSeed = 1;
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> exponents(-30.0, 38.0);
  for (int i = 0; i < 100000; ++i)
  {
    const double margin = std::pow(10.0, exponents(generator));
    const float uploaded = uploadedMargin(margin);
    EXPECT_GE(static_cast<double>(uploaded), margin) << "seed " << kSeed;
    EXPECT_LT(static_cast<double>(std::nextafter(uploaded, 0.0F)), margin) << "seed " << kSeed;
  }
}

TEST(UploadedMargins, ArePositiveAlsoOnADeviceThatReadsTinyNumbersAsZero)
{
  for (const double tiny : {std::numeric_limits<double>::denorm_min(), 1e-300, 1e-45, 1e-40})
    EXPECT_EQ(std::numeric_limits<float>::min(), uploadedMargin(tiny)) << tiny;
}

TEST(UploadedMargins, AreInfiniteAboveTheRangeOfAFloatAndWithoutANumber)
{
  const auto largest = static_cast<double>(std::numeric_limits<float>::max());
  EXPECT_EQ(std::numeric_limits<float>::max(), uploadedMargin(largest));
  EXPECT_EQ(kInfinity, uploadedMargin(std::nextafter(largest, 1e300)));
  EXPECT_EQ(kInfinity, uploadedMargin(1e300));
  EXPECT_EQ(kInfinity, uploadedMargin(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(kInfinity, uploadedMargin(std::numeric_limits<double>::quiet_NaN()));
}

TEST(UploadedMargins, AreNotNegative)
{
  EXPECT_EQ(0.0F, uploadedMargin(-0.1));
  EXPECT_EQ(0.0F, uploadedMargin(-1e300));
  EXPECT_EQ(0.0F, uploadedMargin(-std::numeric_limits<double>::infinity()));
}
}  // namespace
}  // namespace gpu_planning_scene::core
