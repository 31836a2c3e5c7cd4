#include "collision/geometry/oriented_box.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "collision/geometry/cpu_box_pair.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d randomRotation(std::mt19937_64& generator)
{
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(generator), normal(generator), normal(generator), normal(generator))
      .normalized()
      .toRotationMatrix();
}

OrientedBox fit(const std::vector<Triangle>& triangles)
{
  TriangleSpread spread(triangles.front());
  for (std::size_t i = 1; i < triangles.size(); ++i)
    spread = TriangleSpread(spread, TriangleSpread(triangles[i]));
  return fitOrientedBox(spread, triangles.data(), triangles.size());
}

/// Triangles with random corners in a randomly rotated box. Sides of the box may be 0.
std::vector<Triangle> randomTriangles(std::size_t count, const Vector3d& half, const Vector3d& center,
                                      std::mt19937_64& generator)
{
  const Matrix3d axes = randomRotation(generator);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::vector<Triangle> triangles(count);
  for (Triangle& triangle : triangles)
    for (Vector3d& corner : triangle)
      corner = center + axes * half.cwiseProduct(Vector3d(share(generator), share(generator), share(generator)));
  return triangles;
}

void expectValid(const OrientedBox& box, const std::vector<Triangle>& triangles)
{
  ASSERT_TRUE(box.axes.allFinite() && box.center.allFinite() && box.half.allFinite());
  EXPECT_LT((box.axes.transpose() * box.axes - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 2e-15);
  EXPECT_GT(box.axes.determinant(), 0.0);
  Eigen::AlignedBox3d bounds;
  for (const Triangle& triangle : triangles)
    for (const Vector3d& corner : triangle)
    {
      EXPECT_TRUE(box.contains(corner));
      bounds.extend(corner);
    }
  // The enlargement on all sides that rounding may cause.
  const double rounding = 2e-14 * bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).norm();
  const Vector3d aligned = (0.5 * bounds.sizes()).array() + rounding;
  EXPECT_LE(surfaceMeasure(box.half), surfaceMeasure(aligned));
}

TEST(OrientedBox, HoldsItsTrianglesAndIsNoLargerThanTheAlignedBox)
{
  const std::uint64_t seed = 1;
  std::mt19937_64 generator(seed);
  for (const Vector3d& shape : {Vector3d(1, 1, 1), Vector3d(1, 0.3, 0.1), Vector3d(1, 1, 1e-6), Vector3d(1, 0.5, 0),
                                Vector3d(1, 1e-9, 0), Vector3d(1, 0, 0), Vector3d(0, 0, 0)})
    for (const double size : {1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e9})
      for (const double distance : {0.0, 1e-6, 1.0, 1e3, 1e9})
        for (const std::size_t count : {1, 2, 4, 100})
        {
          SCOPED_TRACE(testing::Message() << "seed " << seed << ", shape " << shape.transpose() << ", size " << size
                                          << ", distance " << distance << ", " << count << " triangles");
          const Vector3d center = distance * randomRotation(generator).col(0);
          const std::vector<Triangle> triangles = randomTriangles(count, size * shape, center, generator);
          expectValid(fit(triangles), triangles);
        }
}

TEST(OrientedBox, HoldsDuplicatesAndSlivers)
{
  const Vector3d p(0.1, -0.7, 0.3);
  const Vector3d q(0.4, 0.2, -0.9);
  const Triangle point{p, p, p};
  const Triangle segment{p, q, q};
  const Triangle sliver{p, q, 0.5 * (p + q) + Vector3d(1e-16, 0, 0)};
  const Triangle triangle{p, q, {0, 0, 0}};
  for (const std::vector<Triangle>& triangles : {std::vector<Triangle>{point},
                                                 {point, point, point},
                                                 {segment},
                                                 {segment, segment},
                                                 {sliver},
                                                 {sliver, point},
                                                 {triangle, triangle, triangle, triangle},
                                                 {triangle, sliver}})
    expectValid(fit(triangles), triangles);
}

TEST(OrientedBox, FindsTheAxesOfABoxInAnyTurn)
{
  const std::uint64_t seed = 2;
  std::mt19937_64 generator(seed);
  const Vector3d half(0.4, 0.2, 0.1);
  for (int turn = 0; turn < 100; ++turn)
  {
    const Matrix3d axes = randomRotation(generator);
    std::vector<Triangle> triangles;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0})
      {
        const auto corner = [&](double u, double v)
        {
          Vector3d along;
          along[axis] = side * half[axis];
          along[(axis + 1) % 3] = u * half[(axis + 1) % 3];
          along[(axis + 2) % 3] = v * half[(axis + 2) % 3];
          return Vector3d(axes * along);
        };
        triangles.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
        triangles.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
      }
    EXPECT_NEAR(surfaceMeasure(half), surfaceMeasure(fit(triangles).half), 1e-12)
        << "seed " << seed << ", turn " << turn;
  }
}

TEST(OrientedBoxes, ThatShareAPointOverlap)
{
  const std::uint64_t seed = 3;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::uniform_int_distribution<int> side(-1, 1);
  for (int i = 0; i < 20000; ++i)
  {
    // The common point is a corner, on an edge, on a face, or inside. Every fourth pair has parallel axes.
    OrientedBox boxes[2];
    const Vector3d point(100.0 * share(generator), share(generator), share(generator));
    for (OrientedBox& box : boxes)
    {
      box.axes = &box == &boxes[1] && i % 4 == 0 ? boxes[0].axes : randomRotation(generator);
      box.half = {std::abs(share(generator)), 1e-3 * std::abs(share(generator)), i % 3 == 0 ? 0.0 : 1.0};
      const Vector3d where(side(generator), side(generator), share(generator));
      box.center = point - box.axes * box.half.cwiseProduct(where);
    }
    ASSERT_TRUE(overlap(boxes[0], boxes[1], 1e-9)) << "seed " << seed << ", pair " << i;
    ASSERT_TRUE(overlap(boxes[1], boxes[0], 1e-9)) << "seed " << seed << ", pair " << i;
  }
}

TEST(OrientedBoxes, WithAGapAlongAnAxisOfTheTestDoNotOverlap)
{
  const std::uint64_t seed = 4;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> length(0.1, 1.0);
  const auto reachOf = [](const OrientedBox& box, const Vector3d& axis)
  { return (box.axes.transpose() * axis).cwiseAbs().dot(box.half); };
  for (int i = 0; i < 1500; ++i)
  {
    OrientedBox a{randomRotation(generator), {1, 2, 3}, {length(generator), length(generator), length(generator)}};
    OrientedBox b{randomRotation(generator), {}, {length(generator), length(generator), length(generator)}};
    const int number = i % 15;
    const Vector3d axis = number < 3   ? Vector3d(a.axes.col(number))
                          : number < 6 ? Vector3d(b.axes.col(number - 3))
                                       : a.axes.col((number - 6) / 3).cross(b.axes.col((number - 6) % 3)).normalized();
    const double gap = 1e-6;
    b.center = a.center + (reachOf(a, axis) + reachOf(b, axis) + gap) * axis;
    EXPECT_FALSE(overlap(a, b, 0.0)) << "seed " << seed << ", axis " << number;
    EXPECT_FALSE(overlap(b, a, 0.0)) << "seed " << seed << ", axis " << number;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
