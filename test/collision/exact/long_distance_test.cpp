// Required distances that are long against the triangles: the verdicts are those of all pairs of triangles, and a check
// visits about as many nodes as without a required distance. The same for solids that are large against the triangles.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "collision/exact/cpu_shape_pair.h"
#include "collision/exact/random_geometry.h"
#include "collision/geometry/cpu_box_pair.h"
#include "collision/geometry/primitive_solid.h"
#include "support/obstacles.h"
#include "support/seed.h"
#include "support/triangle_soup.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

std::shared_ptr<const CpuForest> forestOf(const std::vector<Shape>& shapes)
{
  CollisionProblem problem;
  problem.shapes = shapes;
  for (const Shape& shape : shapes)
    problem.tessellations.push_back(tessellate(shape));
  return std::make_shared<const CpuForest>(problem);
}

/// A part with bumps, about `size` long.
std::shared_ptr<const Mesh> part(double size, std::size_t triangles)
{
  return closedSurface(
      "part", triangles, 2.0,
      [size](double along, double angle) -> Vector3d
      {
        const double bumps = 1.0 + 0.02 * std::sin(5.0 * angle) * std::sin(9.0 * along);
        const double across = 0.5 * size * bumps * std::sin(M_PI * along);
        return {across * std::cos(angle), across * std::sin(angle), 0.5 * size * std::cos(M_PI * along)};
      });
}

Isometry3d turned(RandomGeometry& random)
{
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.direction()).toRotationMatrix();
  return pose;
}

/// Moves a shape from far away along -direction to the place where it has the required distance, up to 1e-12 m.
template <class Within>
Isometry3d touching(const Isometry3d& turn, const Vector3d& direction, double far, const Within& within)
{
  double low = 0.0;
  double high = far;
  const auto at = [&](double distance) { return Isometry3d(Translation3d(distance * direction) * turn); };
  for (int i = 0; i < 60; ++i)
  {
    const double middle = 0.5 * (low + high);
    (within(at(middle)) ? low : high) = middle;
  }
  return at(high);
}

TEST(LongDistances, HaveTheVerdictsOfAllPairsOfTriangles)
{
  RandomGeometry random(kSeed);
  for (int i = 0; i < 15; ++i)
  {
    const double size = random.size(1e-3, 0.3);
    const auto corner = [&] { return Vector3d(size * random.uniform(0.0, 1.0) * random.direction()); };
    const std::shared_ptr<const Mesh> a = triangleSoup(40, corner);
    const std::shared_ptr<const Mesh> b = triangleSoup(40, corner);
    const Shape can = Cylinder{size, size};
    const CpuShapePair pair(forestOf({Shape(a), Shape(b), can}));
    const double required = random.size(1e-2, 3.0);
    const auto meshes_within = [&](const Isometry3d& pose)
    {
      for (const auto& t : a->triangles)
        for (const auto& s : b->triangles)
          if (trianglesWithin({a->vertices[t[0]], a->vertices[t[1]], a->vertices[t[2]]},
                              {pose * b->vertices[s[0]], pose * b->vertices[s[1]], pose * b->vertices[s[2]]}, required))
            return true;
      return false;
    };
    const auto solid_within = [&](const Isometry3d& pose)
    {
      const Isometry3d into_solid = pose.inverse();
      return std::any_of(a->triangles.begin(), a->triangles.end(),
                         [&](const auto& t)
                         {
                           return triangleWithinSolid({into_solid * a->vertices[t[0]], into_solid * a->vertices[t[1]],
                                                       into_solid * a->vertices[t[2]]},
                                                      can, required);
                         });
    };
    CpuShapePair::Scratch scratch;
    const Vector3d direction = random.direction();
    const auto compare = [&](std::uint32_t other, const auto& within)
    {
      const Isometry3d touch = touching(turned(random), direction, required + 10.0 * size, within);
      for (const double off :
           {0.0, 1e-10, -1e-10, 1e-8, -1e-8, 1e-5, -1e-5, 0.01 * size, -0.01 * size, -size, -required})
      {
        const Isometry3d pose = Translation3d(off * direction) * touch;
        ASSERT_EQ(within(pose), pair.collide(0, Isometry3d::Identity(), other, pose, required, scratch))
            << "case " << i << ", shape " << other << ", off by " << off << " m, seed " << kSeed;
        // At the threshold itself, the vertices of the other order are rounded in another way.
        ASSERT_TRUE(off == 0.0 ||
                    within(pose) == pair.collide(other, pose, 0, Isometry3d::Identity(), required, scratch))
            << "case " << i << ", shape " << other << ", off by " << off << " m, seed " << kSeed;
      }
    };
    compare(1, meshes_within);
    compare(2, solid_within);
  }
}

/// The visits just outside and just inside of the required distance.
TEST(LongDistances, NeedAtMostTwentyTimesTheVisitsOfNone)
{
  RandomGeometry random(kSeed);
  for (const double size : {0.02, 0.1})
    for (const Shape& other :
         {Shape(part(size, 20000)), Shape(Cylinder{0.4 * size, size}), Shape(Box{{size, size, size}})})
    {
      const CpuShapePair pair(forestOf({Shape(part(size, 20000)), other}));
      CpuShapePair::Scratch scratch;
      std::array<std::uint64_t, 4> most = {};
      const std::array<double, 4> distances = {0.0, 0.03, 0.1, 0.3};
      for (int i = 0; i < 5; ++i)
      {
        const Isometry3d turn = turned(random);
        const Vector3d direction = random.direction();
        for (std::size_t k = 0; k < distances.size(); ++k)
        {
          const auto steps = [&](const Isometry3d& pose, bool expected)
          {
            scratch.steps = 0;
            EXPECT_EQ(expected, pair.collide(0, Isometry3d::Identity(), 1, pose, distances[k], scratch))
                << "shape " << other.index() << ", size " << size << " m, required " << distances[k] << " m, at "
                << pose.translation().norm() << " m, seed " << kSeed;
            most[k] = std::max(most[k], scratch.steps);
          };
          const Isometry3d touch =
              touching(turn, direction, distances[k] + 3.0 * size,
                       [&](const Isometry3d& pose)
                       { return pair.collide(0, Isometry3d::Identity(), 1, pose, distances[k], scratch); });
          for (const double off : {1e-6, 1e-4, 1e-3})
          {
            steps(Translation3d(off * direction) * touch, false);
            steps(Translation3d(-off * direction) * touch, true);
          }
        }
      }
      for (std::size_t k = 1; k < distances.size(); ++k)
        EXPECT_LE(most[k], 20 * most[0]) << "required " << distances[k] << " m, size " << size << " m, seed " << kSeed;
      std::cout << "size " << size << " m: " << most[0] << ", " << most[1] << ", " << most[2] << ", " << most[3]
                << " steps" << std::endl;
    }
}

/// A square plate of 7200 triangles, 1 m long.
std::shared_ptr<const Mesh> plate()
{
  constexpr std::uint32_t kCells = 60;
  auto mesh = std::make_shared<Mesh>();
  for (std::uint32_t i = 0; i <= kCells; ++i)
    for (std::uint32_t j = 0; j <= kCells; ++j)
      mesh->vertices.emplace_back(1.0 * i / kCells - 0.5, 1.0 * j / kCells - 0.5, 0.0);
  for (std::uint32_t i = 0; i < kCells; ++i)
    for (std::uint32_t j = 0; j < kCells; ++j)
    {
      const std::uint32_t corner = i * (kCells + 1) + j;
      mesh->triangles.push_back({corner, corner + 1, corner + kCells + 1});
      mesh->triangles.push_back({corner + 1, corner + kCells + 1, corner + kCells + 2});
    }
  return mesh;
}

/// The distance is within rounding of that at which triangles collide, so the direction between the nearest points is
/// mostly rounding error.
TEST(HugeSolids, NeedFewSearchesForAnAxisThatSeparatesTheirNeighbours)
{
  const double radius = 1000.0;
  const double length = 1000.0;
  const std::vector<Shape> solids = {Cone{radius, length}, Cylinder{radius, length}, Box{{radius, radius, length}}};
  for (std::uint32_t k = 0; k < solids.size(); ++k)
  {
    const CpuShapePair pair(forestOf({Shape(plate()), solids[k]}));
    CpuShapePair::Scratch scratch;
    // The normal of the side at a point half way up.
    const Vector3d normal = k == 0 ? Vector3d(length, 0.0, radius).normalized() : Vector3d::UnitX();
    const Vector3d point(k == 1 ? radius : 0.5 * radius, 0.0, 0.0);
    for (const double gap : {0.7e-9, 1e-9, 2e-9, 1e-8, 1e-6})
    {
      Isometry3d pose = Isometry3d::Identity();
      pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal).toRotationMatrix();
      pose.translation() = point + gap * normal;
      const std::uint64_t before = scratch.axis.searches;
      EXPECT_FALSE(pair.collide(0, pose, 1, Isometry3d::Identity(), 0.0, scratch)) << k << ", " << gap;
      EXPECT_LT(scratch.axis.searches - before, 100U) << k << ", " << gap;
      pose.translation() = point - 1e-6 * normal;
      EXPECT_TRUE(pair.collide(0, pose, 1, Isometry3d::Identity(), 0.0, scratch)) << k;
    }
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
