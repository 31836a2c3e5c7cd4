// DepthView never sees behind a ball if a ray through the ball ends before the ball's far side.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/perception/depth_view.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// The number of rays that pass within `radius` of the ball's centre and end in front of its far side, pixel by pixel.
int endsNear(const PinholeCamera& camera, const std::vector<float>& depths, const Vector3d& centre, double radius)
{
  int count = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
    {
      const auto depth = static_cast<double>(depths[camera.pixel(x, y)]);
      const Vector3d ray = Vector3d((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0).normalized();
      if (depth < centre.z() + radius && (centre - centre.dot(ray) * ray).norm() < radius)
        ++count;
    }
  return count;
}

TEST(DepthView, NeverSeesBehindABallInFrontOfWhichARayEnds)
{
  const std::uint64_t seed = 5;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const PinholeCamera camera{67, 41, 50.0, 45.0, 35.0, 19.0};
  int seen = 0;
  int refuted = 0;
  for (int k = 0; k < 200; ++k)
  {
    std::vector<float> depths(std::size_t{67} * 41, 3.0F);
    for (int i = 0; i < 4; ++i)  // some pixels are nearer, some are no ray
    {
      depths[generator() % depths.size()] = static_cast<float>(1.5 + unit(generator));
      depths[generator() % depths.size()] = kInfinite;
    }
    const DepthView view(camera, depths);
    for (int i = 0; i < 20; ++i)
    {
      const double z = 1.6 + 1.4 * unit(generator);
      const Vector3d centre(0.8 * z * unit(generator), 0.5 * z * unit(generator), z);
      const double radius = 0.3 * std::abs(unit(generator));
      const int nearer = endsNear(camera, depths, centre, radius);
      if (!view.seesBehind(centre, radius))
      {
        refuted += nearer > 0 ? 1 : 0;
        continue;
      }
      ++seen;
      EXPECT_EQ(0, nearer) << centre.transpose() << ", radius " << radius;
    }
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(refuted, 300);
}

TEST(DepthView, SeesBehindBallsThatAreWellInFrontOfAWall)
{
  const PinholeCamera camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  const DepthView view(camera, std::vector<float>(std::size_t{64} * 48, 2.0F));
  EXPECT_TRUE(view.seesBehind({0.0, 0.0, 1.0}, 0.05));
  EXPECT_TRUE(view.seesBehind({0.0, 0.0, 1.9}, 0.05));
  EXPECT_TRUE(view.seesBehind({0.2, -0.2, 0.6}, 0.4)) << "a large part of the image";
  EXPECT_FALSE(view.seesBehind({0.0, 0.0, 1.98}, 0.05)) << "the ball contains a part of the wall";
  EXPECT_FALSE(view.seesBehind({0.0, 0.0, 2.5}, 0.05)) << "behind the wall";
  EXPECT_FALSE(view.seesBehind({1.5, 0.0, 1.0}, 0.05)) << "beside the image";
  EXPECT_FALSE(view.seesBehind({0.0, 0.0, -1.0}, 0.05)) << "behind the camera";
  EXPECT_FALSE(view.seesBehind({0.0, 0.0, 0.03}, 0.05)) << "around the camera";
  EXPECT_FALSE(DepthView(camera, std::vector<float>(std::size_t{64} * 48, kInfinite)).seesBehind({0.0, 0.0, 1.0}, 0.05))
      << "no ray is measured";
}

TEST(DepthView, DoesNotSeeBehindABallBesideANearerSurface)
{
  // The ball is between the columns 30 and 33. The surface ends at a column to the left.
  const PinholeCamera camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  const auto sees = [&](int last_column)
  {
    std::vector<float> depths(std::size_t{64} * 48, 5.0F);
    for (int y = 0; y < 48; ++y)
      std::fill_n(depths.begin() + std::ptrdiff_t{64} * y, last_column + 1, 0.5F);
    return DepthView(camera, depths).seesBehind({0.0, 0.0, 2.0}, 0.04);
  };
  EXPECT_FALSE(sees(29)) << "one pixel beside it";
  EXPECT_TRUE(sees(27));
}

TEST(DepthView, DoesNotSeeThroughAFloorAtAGrazingAngle)
{
  // The camera is 1 m above the floor and looks forward. The distance of two rays on the floor is larger than a voxel.
  const PinholeCamera camera{64, 48, 60.0, 60.0, 31.5, 0.0};
  std::vector<float> depths;
  for (int y = 0; y < 48; ++y)
    depths.insert(depths.end(), 64, y == 0 ? 100.0F : static_cast<float>(60.0 / y));
  const DepthView view(camera, depths);
  int seen = 0;
  for (int i = 0; i < 500; ++i)
    seen += view.seesBehind({0.0, 1.0, 2.0 + 0.01 * i}, 0.0087) ? 1 : 0;  // the balls of voxels of 1 cm
  EXPECT_EQ(0, seen);
}
}  // namespace
}  // namespace gpu_planning_scene::core
