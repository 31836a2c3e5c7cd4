#include "collision/geometry/median_split.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

TEST(MedianSplit, HalvesTheElementsAlongTheLongestExtentOfTheirCentres)
{
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int longest = 0; longest < 3; ++longest)
    for (const std::size_t count : {1U, 2U, 3U, 8U, 41U})
    {
      std::vector<Vector3d> centers(count);
      std::vector<std::size_t> elements(count);
      for (std::size_t i = 0; i < count; ++i)
      {
        elements[i] = i;
        centers[i] = {uniform(generator), uniform(generator), uniform(generator)};
        centers[i][longest] *= 100.0;
      }
      const auto centerOf = [&centers](std::size_t element) -> const Vector3d& { return centers[element]; };
      const auto middle = splitAtMedian(elements.begin(), elements.end(), centerOf);
      EXPECT_EQ(static_cast<std::ptrdiff_t>(count / 2), middle - elements.begin());
      for (auto first = elements.begin(); first != middle; ++first)
        for (auto second = middle; second != elements.end(); ++second)
          EXPECT_LE(centers[*first][longest], centers[*second][longest]);
    }
}
}  // namespace
}  // namespace gpu_planning_scene::core
