#include "collision/geometry/primitive_solid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "support/inside.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

const Box kBox{{0.3, 0.2, 0.4}};
const Sphere kSphere{0.2};
const Cylinder kCylinder{0.2, 0.3};
const Cone kCone{0.2, 0.5};

/// The smallest value of a convex function on [lower, upper].
double minimum(const std::function<double(double)>& function, double lower, double upper)
{
  for (int i = 0; i < 45; ++i)
  {
    const double left = lower + (upper - lower) * 0.4;
    const double right = lower + (upper - lower) * 0.6;
    (function(left) < function(right) ? upper : lower) = function(left) < function(right) ? right : left;
  }
  return function(0.5 * (lower + upper));
}

/// The smallest distance to the solid over the triangle. The distance to a convex solid is a convex function.
double distance(const Triangle& t, const Shape& shape)
{
  return minimum(
      [&](double u)
      {
        return minimum([&](double v)
                       { return distanceToSolid(shape, t[0] + u * (t[1] - t[0]) + v * (1.0 - u) * (t[2] - t[0])); },
                       0.0, 1.0);
      },
      0.0, 1.0);
}

/// Two unit vectors that are perpendicular to a unit vector and to each other.
std::array<Vector3d, 2> directionsAcross(const Vector3d& normal)
{
  const Vector3d u = normal.cross(std::abs(normal.x()) < 0.5 ? Vector3d::UnitX() : Vector3d::UnitY()).normalized();
  return {u, normal.cross(u)};
}

class PrimitiveSolid : public testing::TestWithParam<Shape>
{
};

TEST_P(PrimitiveSolid, DistanceIsThatToTheNearestOfManyInnerPoints)
{
  const std::uint64_t seed = 3;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> coordinate(-0.6, 0.6);
  constexpr int kSteps = 24;
  const Vector3d half = halfExtents(GetParam());
  const Vector3d step = 2.0 * half / kSteps;
  for (int i = 0; i < 50; ++i)
  {
    const Vector3d p(coordinate(generator), coordinate(generator), coordinate(generator));
    double nearest = std::numeric_limits<double>::infinity();
    for (int x = 0; x <= kSteps; ++x)
    {
      for (int y = 0; y <= kSteps; ++y)
      {
        for (int z = 0; z <= kSteps; ++z)
        {
          const Vector3d q = Vector3d(x, y, z).cwiseProduct(step) - half;
          nearest = isInside(GetParam(), q) ? std::min(nearest, (p - q).norm()) : nearest;
        }
      }
    }
    const double found = distanceToSolid(GetParam(), p);
    EXPECT_LE(found, nearest + 1e-12) << "seed " << seed << ", point " << p.transpose();
    EXPECT_GE(found, nearest - 2.0 * step.norm()) << "seed " << seed << ", point " << p.transpose();
    EXPECT_EQ(isInside(GetParam(), p), found == 0.0) << "seed " << seed << ", point " << p.transpose();
  }
}

TEST_P(PrimitiveSolid, MeetsATriangleWhereItsDistanceIsZero)
{
  const std::uint64_t seed = 4;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  int hits = 0;
  constexpr int kTriangles = 300;
  for (int i = 0; i < kTriangles; ++i)
  {
    // Small triangles at random places, and large triangles that may cut the solid with no edge in it.
    const double size = std::array<double, 3>{0.1, 0.4, 2.0}[i % 3];
    const Vector3d place = 0.3 * Vector3d(coordinate(generator), coordinate(generator), coordinate(generator));
    Triangle t;
    for (Vector3d& vertex : t)
      vertex = place + size * Vector3d(coordinate(generator), coordinate(generator), coordinate(generator));
    if (i % 10 == 0)
      t[2] = 0.5 * (t[0] + t[1]);  // a segment
    const double apart = distance(t, GetParam());
    const bool meets = triangleWithinSolid(t, GetParam(), 0.0);
    hits += meets;
    if (apart > 1e-7)
      EXPECT_FALSE(meets) << "seed " << seed << ", triangle " << i << ", distance " << apart;
    if (apart == 0.0)
      EXPECT_TRUE(meets) << "seed " << seed << ", triangle " << i;
  }
  EXPECT_GT(hits, kTriangles / 10);
  EXPECT_LT(hits, kTriangles * 9 / 10);
}

TEST_P(PrimitiveSolid, ContainsASmallTriangleAndIsCutByAHugeOne)
{
  const Triangle small = {Vector3d(0.01, 0, 0), Vector3d(0, 0.01, 0), Vector3d(0, 0, 0.01)};
  EXPECT_TRUE(triangleWithinSolid(small, GetParam(), 0.0));
  const Vector3d half = halfExtents(GetParam());
  for (const Vector3d& normal : {Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(1, 2, 3), Vector3d(1, 0, 1e-9)})
  {
    const auto [u, v] = directionsAcross(normal.normalized());
    const Triangle huge = {-50 * u - 40 * v, 50 * u - 40 * v, 60 * v};
    EXPECT_TRUE(triangleWithinSolid(huge, GetParam(), 0.0)) << normal.transpose();
    const Vector3d beyond = (half.norm() + 0.01) * normal.normalized();
    const Triangle above = {huge[0] + beyond, huge[1] + beyond, huge[2] + beyond};
    EXPECT_FALSE(triangleWithinSolid(above, GetParam(), 0.0)) << normal.transpose();
  }
}
std::string kindOf(const testing::TestParamInfo<Shape>& parameter)
{
  constexpr std::array<const char*, 4> kNames = {"Box", "Sphere", "Cylinder", "Cone"};
  return kNames[parameter.param.index()];
}
INSTANTIATE_TEST_SUITE_P(Kinds, PrimitiveSolid,
                         testing::Values(Shape(kBox), Shape(kSphere), Shape(kCylinder), Shape(kCone)), kindOf);

TEST(PrimitiveSolid, TouchesAtTheTrueSurfaceAndNotBeyond)
{
  // A triangle in the tangent plane at `point`, moved outwards by `gap`.
  const auto touches = [](const Shape& shape, const Vector3d& point, const Vector3d& outward, double gap)
  {
    const Vector3d n = outward.normalized();
    const auto [u, v] = directionsAcross(n);
    const Vector3d at = point + gap * n;
    return triangleWithinSolid({at - u - v, at + u - v, at + 1.5 * v}, shape, 0.0);
  };
  const double angle = 0.7;  // not an angle of any vertex of the tessellations
  const Vector3d radial(std::cos(angle), std::sin(angle), 0.0);
  struct SurfaceContact
  {
    Shape shape;
    Vector3d point;
    Vector3d outward;
  };
  const std::vector<SurfaceContact> contacts = {
      {kBox, Vector3d(0.15, 0.03, 0.02), Vector3d(1, 0, 0)},
      {kBox, Vector3d(0.15, 0.10, 0.20), Vector3d(1, 1, 1)},
      {kSphere, 0.2 * Vector3d(1, 2, 3).normalized(), Vector3d(1, 2, 3)},
      {kCylinder, 0.2 * radial + 0.05 * Vector3d::UnitZ(), radial},
      {kCylinder, 0.15 * Vector3d::UnitZ() + 0.1 * radial, Vector3d::UnitZ()},
      {kCylinder, 0.15 * Vector3d::UnitZ() + 0.2 * radial, Vector3d::UnitZ() + radial},
      {kCone, 0.1 * radial, 0.5 * radial + 0.2 * Vector3d::UnitZ()},
      {kCone, 0.25 * Vector3d::UnitZ(), Vector3d::UnitZ()},
      {kCone, -0.25 * Vector3d::UnitZ() + 0.1 * radial, -Vector3d::UnitZ()},
  };
  for (const SurfaceContact& contact : contacts)
  {
    EXPECT_TRUE(touches(contact.shape, contact.point, contact.outward, 0.0)) << contact.point.transpose();
    EXPECT_FALSE(touches(contact.shape, contact.point, contact.outward, 1e-9)) << contact.point.transpose();
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
