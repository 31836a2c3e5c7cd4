// DepthView never sees behind a voxel if a ray through the ball inside it ends before its far side.

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

/// A cube whose edges are parallel to the camera's axes. The ball inside it has the radius.
VoxelInView cubeAt(const Vector3d& centre, double radius)
{
  return {centre, Vector3d::Constant(radius), radius};
}

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

TEST(DepthView, NeverSeesBehindAVoxelInFrontOfWhichARayEnds)
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
      if (!view.seesBehind(cubeAt(centre, radius)))
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

TEST(DepthView, SeesBehindVoxelsThatAreWellInFrontOfAWall)
{
  const PinholeCamera camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  const DepthView view(camera, std::vector<float>(std::size_t{64} * 48, 2.0F));
  EXPECT_TRUE(view.seesBehind(cubeAt({0.0, 0.0, 1.0}, 0.05)));
  EXPECT_TRUE(view.seesBehind(cubeAt({0.0, 0.0, 1.9}, 0.05)));
  EXPECT_TRUE(view.seesBehind(cubeAt({0.2, -0.2, 0.6}, 0.4))) << "a large part of the image";
  EXPECT_FALSE(view.seesBehind(cubeAt({0.0, 0.0, 1.98}, 0.05))) << "the voxel contains a part of the wall";
  EXPECT_FALSE(view.seesBehind(cubeAt({0.0, 0.0, 2.5}, 0.05))) << "behind the wall";
  EXPECT_FALSE(view.seesBehind(cubeAt({1.5, 0.0, 1.0}, 0.05))) << "beside the image";
  EXPECT_FALSE(view.seesBehind(cubeAt({0.0, 0.0, -1.0}, 0.05))) << "behind the camera";
  EXPECT_FALSE(view.seesBehind(cubeAt({0.0, 0.0, 0.03}, 0.05))) << "around the camera";
  EXPECT_FALSE(
      DepthView(camera, std::vector<float>(std::size_t{64} * 48, kInfinite)).seesBehind(cubeAt({0.0, 0.0, 1.0}, 0.05)))
      << "no ray is measured";
}

TEST(DepthView, DoesNotSeeBehindAVoxelBesideANearerSurface)
{
  // The voxel is between the columns 30 and 33. The surface ends at a column to the left.
  const PinholeCamera camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  const auto sees = [&](int last_column)
  {
    std::vector<float> depths(std::size_t{64} * 48, 5.0F);
    for (int y = 0; y < 48; ++y)
      std::fill_n(depths.begin() + std::ptrdiff_t{64} * y, last_column + 1, 0.5F);
    return DepthView(camera, depths).seesBehind(cubeAt({0.0, 0.0, 2.0}, 0.04));
  };
  EXPECT_FALSE(sees(29)) << "one pixel beside it";
  EXPECT_TRUE(sees(27));
}

/// The camera looks at large voxels through squares of many pixels, but only the pixels near a voxel count.
TEST(DepthView, SeesBehindALargeVoxelUnlessARayEndsNearIt)
{
  const PinholeCamera camera{640, 480, 600.0, 600.0, 319.5, 239.5};
  const VoxelInView voxel = cubeAt({0.03, -0.02, 1.0}, 0.05);
  const auto sees = [&](int x, int y)
  {
    std::vector<float> depths(std::size_t{640} * 480, 5.0F);
    depths[camera.pixel(x, y)] = 0.5F;
    return DepthView(camera, depths).seesBehind(voxel);
  };
  // The voxel's box takes the columns 306.9 to 370.1 and the rows 195.3 to 258.4, by its near side.
  for (const int y : {196, 227, 258})
    for (int x = 290; x < 390; ++x)
      EXPECT_EQ(sees(x, y), x < 305 || x > 372) << x << " " << y;
  for (const int x : {307, 340, 370})
    for (int y = 180; y < 280; ++y)
      EXPECT_EQ(sees(x, y), y < 194 || y > 260) << x << " " << y;
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
    seen += view.seesBehind(cubeAt({0.0, 1.0, 2.0 + 0.01 * i}, 0.005)) ? 1 : 0;  // voxels of 1 cm
  EXPECT_EQ(0, seen);
}
}  // namespace
}  // namespace gpu_planning_scene::core
