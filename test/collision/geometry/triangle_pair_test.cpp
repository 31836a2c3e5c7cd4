#include "collision/geometry/triangle_pair.h"

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/moving_shape.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;
using IntPoint = std::array<std::int64_t, 3>;
using IntTriangle = std::array<IntPoint, 3>;

IntPoint minus(const IntPoint& a, const IntPoint& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

IntPoint cross(const IntPoint& a, const IntPoint& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

std::int64_t dot(const IntPoint& a, const IntPoint& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool isZero(const IntPoint& a)
{
  return a == IntPoint{0, 0, 0};
}

bool originInSegment(const IntPoint& a, const IntPoint& b)
{
  return isZero(cross(a, b)) && dot(a, b) <= 0;
}

bool originInTriangle(const IntPoint& a, const IntPoint& b, const IntPoint& c)
{
  const IntPoint n = cross(minus(b, a), minus(c, a));
  if (isZero(n))
    return originInSegment(a, b) || originInSegment(b, c) || originInSegment(c, a);
  return dot(n, a) == 0 && dot(n, cross(a, b)) >= 0 && dot(n, cross(b, c)) >= 0 && dot(n, cross(c, a)) >= 0;
}

bool originInTetrahedron(const IntPoint& a, const IntPoint& b, const IntPoint& c, const IntPoint& d)
{
  const std::int64_t volume = dot(cross(minus(b, a), minus(c, a)), minus(d, a));
  if (volume == 0)
  {
    return originInTriangle(a, b, c) || originInTriangle(a, b, d) || originInTriangle(a, c, d) ||
           originInTriangle(b, c, d);
  }
  const std::int64_t sign = volume > 0 ? 1 : -1;
  // The signed volumes with one corner replaced by the origin.
  return sign * dot(cross(b, c), d) >= 0 && sign * dot(cross(a, d), c) >= 0 && sign * dot(cross(a, b), d) >= 0 &&
         sign * dot(cross(a, c), b) >= 0;
}

/// An exact test. Two convex sets meet if the origin is in the convex hull of the differences of their points
/// (Minkowski). The origin is then in a tetrahedron of four of the differences (Caratheodory).
bool meetExactly(const IntTriangle& p, const IntTriangle& q)
{
  std::vector<IntPoint> differences;
  for (const IntPoint& a : p)
    for (const IntPoint& b : q)
      differences.push_back(minus(a, b));
  for (std::size_t i = 0; i < 9; ++i)
  {
    for (std::size_t j = i + 1; j < 9; ++j)
    {
      for (std::size_t k = j + 1; k < 9; ++k)
      {
        for (std::size_t l = k + 1; l < 9; ++l)
          if (originInTetrahedron(differences[i], differences[j], differences[k], differences[l]))
            return true;
      }
    }
  }
  return false;
}

IntTriangle randomTriangle(std::mt19937_64& generator, int reach)
{
  std::uniform_int_distribution<std::int64_t> coordinate(-reach, reach);
  IntTriangle triangle;
  for (IntPoint& point : triangle)
    point = {coordinate(generator), coordinate(generator), coordinate(generator)};
  return triangle;
}

Triangle placed(const IntTriangle& triangle, const Eigen::Isometry3d& pose, double scale)
{
  Triangle result;
  for (int i = 0; i < 3; ++i)
  {
    result[i] =
        pose * Vector3d(scale * static_cast<double>(triangle[i][0]), scale * static_cast<double>(triangle[i][1]),
                        scale * static_cast<double>(triangle[i][2]));
  }
  return result;
}

class TrianglePair : public testing::TestWithParam<int>
{
};

// On a coarse grid, many pairs touch, are coplanar, or have a degenerate triangle.
TEST_P(TrianglePair, AgreesWithExactIntegersOnAGridInEveryPlaceAndSize)
{
  const std::uint64_t seed = 20261101 + GetParam();
  std::mt19937_64 generator(seed);
  int hits = 0;
  for (int i = 0; i < 4000; ++i)
  {
    const IntTriangle p = randomTriangle(generator, GetParam());
    const IntTriangle q = randomTriangle(generator, GetParam());
    const bool expected = meetExactly(p, q);
    hits += expected;
    const Eigen::Isometry3d somewhere = randomPose(generator, 1.0);
    for (const double scale : {1.0, 0.01, 100.0})
    {
      ASSERT_EQ(expected, trianglesWithin(placed(p, Eigen::Isometry3d::Identity(), scale),
                                          placed(q, Eigen::Isometry3d::Identity(), scale), 0.0))
          << "seed " << seed << ", pair " << i << ", scale " << scale;
      ASSERT_EQ(expected, trianglesWithin(placed(p, somewhere, scale), placed(q, somewhere, scale), 0.0))
          << "seed " << seed << ", pair " << i << ", moved, scale " << scale;
    }
  }
  EXPECT_GT(hits, 400);
  EXPECT_LT(hits, 3600);
}
INSTANTIATE_TEST_SUITE_P(Grids, TrianglePair, testing::Values(1, 2, 5, 20));

TEST(TrianglePair, DoesNotDependOnTheOrderOfVerticesAndTriangles)
{
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  const std::uint64_t seed = 7;
  std::mt19937_64 generator(seed);
  for (int i = 0; i < 1000; ++i)
  {
    const Triangle p = placed(randomTriangle(generator, 2), randomPose(generator, 0.1), 0.1);
    const Triangle q = placed(randomTriangle(generator, 2), randomPose(generator, 0.1), 0.1);
    const bool expected = trianglesWithin(p, q, 0.0);
    for (const auto& a : kOrders)
    {
      for (const auto& b : kOrders)
      {
        const Triangle p_again = {p[a[0]], p[a[1]], p[a[2]]};
        const Triangle q_again = {q[b[0]], q[b[1]], q[b[2]]};
        ASSERT_EQ(expected, trianglesWithin(p_again, q_again, 0.0)) << "seed " << seed << ", pair " << i;
        ASSERT_EQ(expected, trianglesWithin(q_again, p_again, 0.0)) << "seed " << seed << ", pair " << i;
      }
    }
  }
}

TEST(TrianglePair, SeesASmallTriangleAtTheBorderOfAHugeOne)
{
  const Triangle ground = {Vector3d(0, -500, 0), Vector3d(0, 500, 0), Vector3d(-1000, 0, 0)};
  for (const double overlap : {1e-3, 1e-5, 1e-7, 1e-9})
  {
    const auto small_at = [](double x) {
      return Triangle{Vector3d(x, 3.001, -0.005), Vector3d(x + 0.01, 3.0, 0.004), Vector3d(x + 0.01, 3.002, 0.005)};
    };
    const double crossing = 0.01 * 0.005 / 0.010;  // distance from x to the place where the third side crosses z = 0
    EXPECT_TRUE(trianglesWithin(ground, small_at(-crossing - overlap), 0.0)) << overlap;
    EXPECT_FALSE(trianglesWithin(ground, small_at(-crossing + overlap), 0.0)) << overlap;
  }
}

TEST(TrianglePair, KeepsTouchingAndFreesANanometreOfClearance)
{
  const std::uint64_t seed = 11;
  std::mt19937_64 generator(seed);
  const Triangle flat = {Vector3d(-1, -1, 0), Vector3d(1, -1, 0), Vector3d(0, 1, 0)};
  const auto resting_at = [](double height)
  {
    return std::array<Triangle, 3>{
        Triangle{Vector3d(0.1, 0, height), Vector3d(0.3, 0, 1), Vector3d(0, 0.3, 1)},
        Triangle{Vector3d(0.1, 0, height), Vector3d(0.3, 0, height), Vector3d(0, 0.3, 1)},
        Triangle{Vector3d(0.1, 0, height), Vector3d(0.3, 0, height), Vector3d(0, 0.3, height)}};
  };
  for (int i = 0; i < 1000; ++i)
  {
    const Eigen::Isometry3d pose = randomPose(generator, 10.0);
    const auto moved = [&pose](const Triangle& t) { return Triangle{pose * t[0], pose * t[1], pose * t[2]}; };
    for (int kind = 0; kind < 3; ++kind)
    {
      EXPECT_TRUE(trianglesWithin(moved(flat), moved(resting_at(0.0)[kind]), 0.0))
          << "seed " << seed << ", contact " << kind;
      EXPECT_FALSE(trianglesWithin(moved(flat), moved(resting_at(1e-9)[kind]), 0.0))
          << "seed " << seed << ", contact " << kind;
    }
  }
}

TEST(TrianglePair, WithinMeansDistanceAtMostTheRequiredOne)
{
  const Triangle flat = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const Triangle above_face = {Vector3d(0.2, 0.2, 0.5), Vector3d(0.3, 0.2, 1), Vector3d(0.2, 0.3, 1)};
  const Triangle edge_on = {Vector3d(0.5, -0.3, -1), Vector3d(0.5, -0.3, 1), Vector3d(0.5, -2, 0)};
  const Triangle piercing = {Vector3d(0.2, 0.2, -1), Vector3d(0.2, 0.2, 1), Vector3d(0.25, 0.2, 1)};
  EXPECT_TRUE(trianglesWithin(flat, above_face, 0.5));
  EXPECT_FALSE(trianglesWithin(flat, above_face, 0.5 - 1.001e-9));
  EXPECT_TRUE(trianglesWithin(flat, edge_on, 0.3));
  EXPECT_FALSE(trianglesWithin(flat, edge_on, 0.3 - 1.001e-9));
  EXPECT_TRUE(trianglesWithin(flat, piercing, 0.0));
}
}  // namespace
}  // namespace gpu_planning_scene::core
