// Convex shapes at exactly known distances. A point of the first shape has an outward normal n, and a point of the
// second has the outward normal -n. The second point is placed at distance d along n from the first. Two parallel
// planes at distance d then separate the shapes, so d is their distance for all convex shapes.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "collision/geometry/primitive_solid.h"
#include "support/moving_shape.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

struct Feature
{
  Vector3d point;
  Vector3d normal;
  bool smooth;  // the normal is unique, so the inside lies directly below the point
};

class Features
{
 public:
  explicit Features(std::uint64_t seed) : generator(seed) {}

  std::mt19937_64 generator;

  double share() { return std::uniform_real_distribution<double>(0.0, 1.0)(generator); }
  double sign() { return share() < 0.5 ? -1.0 : 1.0; }
  Vector3d around() { return Eigen::AngleAxisd(7.0 * share(), Vector3d::UnitZ()) * Vector3d::UnitX(); }

  Feature of(const Shape& shape, int kind)
  {
    if (const auto* box = std::get_if<Box>(&shape))
      return ofBox(0.5 * box->size, kind);
    if (const auto* sphere = std::get_if<Sphere>(&shape))
    {
      const Vector3d n = randomPose(generator, 1.0).linear().col(0);
      return {sphere->radius * n, n, true};
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape))
      return ofCylinder(*cylinder, kind);
    return ofCone(std::get<Cone>(shape), kind);
  }

  Feature of(const Triangle& t, int kind)
  {
    const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    if (kind == 0)
    {
      const double first = share();
      return {t[0] + first * ((t[1] - t[0]) + share() * (t[2] - t[1])), sign() * n, false};
    }
    // A normal at an edge: rotated about the edge, away from the inside.
    const Vector3d edge = (t[1] - t[0]).normalized();
    const Vector3d outward = edge.cross(n);
    const Vector3d normal = std::cos(1.5 * share()) * outward + std::sin(1.5 * share()) * sign() * n;
    if (kind == 1)
      return {t[0] + share() * (t[1] - t[0]), normal.normalized(), false};
    // The sum of normals of two edges is a normal at their common vertex.
    const Vector3d other = (t[2] - t[1]).normalized().cross(n);
    return {t[1], (outward + share() * other + 0.5 * sign() * n).normalized(), false};
  }

 private:
  Feature ofBox(const Vector3d& half, int kind)
  {
    const Vector3d signs(sign(), sign(), sign());
    if (kind == 0)
    {
      return {Vector3d(signs.x() * half.x(), share() * half.y(), -share() * half.z()), signs.x() * Vector3d::UnitX(),
              true};
    }
    if (kind == 1)
    {
      return {Vector3d(signs.x() * half.x(), signs.y() * half.y(), share() * half.z()),
              Vector3d(signs.x() * share(), signs.y(), 0.0).normalized(), false};
    }
    return {signs.cwiseProduct(half), signs.cwiseProduct(Vector3d(share(), share(), 1.0)).normalized(), false};
  }

  Feature ofCylinder(const Cylinder& c, int kind)
  {
    const Vector3d radial = around();
    const Vector3d up = sign() * Vector3d::UnitZ();
    if (kind == 0)
      return {c.radius * radial + (share() - 0.5) * c.length * Vector3d::UnitZ(), radial, true};
    if (kind == 1)
      return {0.5 * c.length * up + share() * c.radius * radial, up, true};
    return {0.5 * c.length * up + c.radius * radial, (share() * up + share() * radial).normalized(), false};
  }

  Feature ofCone(const Cone& c, int kind)
  {
    const Vector3d radial = around();
    const Vector3d apex = 0.5 * c.length * Vector3d::UnitZ();
    const Vector3d rim = c.radius * radial - apex;
    const Vector3d slant = (c.length * radial + c.radius * Vector3d::UnitZ()).normalized();
    switch (kind)
    {
      case 0:
        return {apex + share() * (rim - apex), slant, true};
      case 1:
        return {share() * c.radius * radial - apex, -Vector3d::UnitZ(), true};
      case 2:
        return {rim, (share() * slant - share() * Vector3d::UnitZ()).normalized(), false};
      default:
        return {apex, (share() * slant + share() * Vector3d::UnitZ()).normalized(), false};
    }
  }
};

/// A right-handed orthonormal basis whose z axis is `normal`.
Eigen::Matrix3d basisOf(const Vector3d& normal)
{
  Eigen::Matrix3d basis;
  basis.col(0) = normal.unitOrthogonal();
  basis.col(1) = normal.cross(basis.col(0));
  basis.col(2) = normal;
  return basis;
}

/// The pose of b that places its feature at `distance` along the normal of a's feature, with the rotation `turn` about
/// the normal.
Isometry3d placed(const Feature& a, const Feature& b, double distance, double turn)
{
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = basisOf(-a.normal) * Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * basisOf(b.normal).transpose();
  pose.translation() = a.point + distance * a.normal - pose.linear() * b.point;
  return pose;
}

Shape scaled(const Shape& shape, double scale)
{
  if (const auto* box = std::get_if<Box>(&shape))
    return Box{scale * box->size};
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return Sphere{scale * sphere->radius};
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return Cylinder{scale * cylinder->radius, scale * cylinder->length};
  const auto& cone = std::get<Cone>(shape);
  return Cone{scale * cone.radius, scale * cone.length};
}

const std::vector<Shape> kSolids = {Box{{0.3, 0.2, 0.4}}, Sphere{0.2},       Cylinder{0.2, 0.3},
                                    Cone{0.2, 0.5},       Cylinder{0.01, 1}, Box{{1.0, 1.0, 1e-3}}};
const std::vector<double> kOffsets = {0.0,     1e-3,  1e-5,   1e-7,     2e-9,  1.01e-9, 5.1e-10,
                                      4.9e-10, 1e-12, -1e-12, -4.9e-10, -1e-9, -1e-7,   -1e-4};
const std::vector<double> kRequired = {0.0, 0.0, 0.02, 0.0, 0.5};
const std::vector<double> kScales = {1.0, 1.0, 0.01, 1.0, 100.0};

template <class Value>
const Value& pick(const std::vector<Value>& values, int i)
{
  return values[static_cast<std::size_t>(i) % values.size()];
}

/// The distance of the features along the normal. `known`: whether it decides the verdict. With a negative distance the
/// shapes overlap if one of the surfaces is smooth there and the penetration is small.
struct Gap
{
  double required;
  double distance;
  bool known;
};

Gap gapOf(int i, const Feature& a, const Feature& b, double scale)
{
  const double required = pick(kRequired, i / 14);
  const double distance = required + pick(kOffsets, i);
  return {required, distance, distance >= 0.0 || ((a.smooth || b.smooth) && distance > -1e-3 * scale)};
}

class SolidContact : public testing::TestWithParam<int>
{
 protected:
  const Shape& solid() const { return kSolids[static_cast<std::size_t>(GetParam())]; }
};

TEST_P(SolidContact, OfTwoSolidsIsDecidedByTheirDistance)
{
  const std::uint64_t seed = 41;
  Features features(seed);
  int decided = 0;
  for (int i = 0; i < 1400; ++i)
  {
    const double scale = pick(kScales, i / 3);
    const Shape a = scaled(solid(), scale);
    const Shape b = scaled(pick(kSolids, i / 2), scale);
    const Feature on_a = features.of(a, i % 4);
    const Feature on_b = features.of(b, i / 4 % 4);
    const Gap gap = gapOf(i, on_a, on_b, scale);
    if (!gap.known)
      continue;
    ++decided;
    const Isometry3d b_in_a = placed(on_a, on_b, gap.distance, 7.0 * features.share());
    const bool expected = gap.distance <= gap.required + kSlack;
    ASSERT_EQ(expected, solidsWithin(a, b, b_in_a, gap.required))
        << "seed " << seed << ", case " << i << ", kinds " << a.index() << " and " << b.index() << ", distance "
        << gap.distance << ", required " << gap.required;
    ASSERT_EQ(expected, solidsWithin(b, a, b_in_a.inverse(), gap.required)) << "seed " << seed << ", case " << i;
  }
  EXPECT_GT(decided, 800);
}

TEST_P(SolidContact, OfATriangleIsDecidedByItsDistanceInEveryOrder)
{
  const std::uint64_t seed = 42;
  Features features(seed);
  for (int i = 0; i < 1400; ++i)
  {
    const double scale = pick(kScales, i / 3);
    const Shape a = scaled(solid(), scale);
    const double size = scale * std::pow(10.0, i / 7 % 3 - 1);
    const double thin = std::pow(10.0, -(i / 11 % 6));
    const Triangle triangle = {size * Vector3d(-1, 0.2 * thin, 0), size * Vector3d(1.1, 0.1 * thin, 0),
                               size * Vector3d(0.2, thin, 0)};
    const Feature on_a = features.of(a, i % 4);
    const Feature on_b = features.of(triangle, i / 4 % 3);
    const Gap gap = gapOf(i, on_a, on_b, scale);
    if (!gap.known)
      continue;
    const Isometry3d pose = placed(on_a, on_b, gap.distance, 7.0 * features.share());
    const Triangle t = {pose * triangle[0], pose * triangle[1], pose * triangle[2]};
    const bool expected = gap.distance <= gap.required + kSlack;
    for (const Triangle& ordered : {t, Triangle{t[1], t[2], t[0]}, Triangle{t[2], t[1], t[0]}})
    {
      ASSERT_EQ(expected, triangleWithinSolid(ordered, a, gap.required))
          << "seed " << seed << ", case " << i << ", kind " << a.index() << ", distance " << gap.distance
          << ", required " << gap.required;
    }
  }
}

TEST_P(SolidContact, TurnedSolidsOverlapOrNotAsPointsOfThemSay)
{
  const std::uint64_t seed = 43;
  Features features(seed);
  int apart = 0;
  for (int i = 0; i < 200; ++i)
  {
    const Shape& b = pick(kSolids, i);
    const Isometry3d b_in_a = randomPose(features.generator, 0.35);
    const bool answer = solidsWithin(solid(), b, b_in_a, 0.0);
    apart += answer ? 0 : 1;
    double least = 1.0;
    for (int k = 0; k < 200; ++k)
    {
      // A point between b's centre and its surface belongs to b.
      const Vector3d point = features.share() * features.of(b, k % 4).point;
      least = std::min(least, distanceToSolid(solid(), b_in_a * point));
    }
    if (least == 0.0)
      EXPECT_TRUE(answer) << "seed " << seed << ", case " << i << ", kind " << b.index();
    EXPECT_TRUE(solidsWithin(solid(), b, b_in_a, least)) << "seed " << seed << ", case " << i;
  }
  EXPECT_GT(apart, 10);
}
TEST(BoxContact, ASliverAboveALongThinBoxIsFree)
{
  // All corners are at least 2.6e-9 m above the box. The simplices of an iterative distance search are nearly flat
  // here.
  const std::vector<std::pair<Box, Triangle>> cases = {
      {{{39.811815600992063, 3.5879585704587723e-07, 0.58235358181467145}},
       {Vector3d(7.4944935299905122, 8.5264545792534179e-08, 0.29117679396769786),
        Vector3d(7.4944935708168599, -1.3328012889075351e-08, 0.29117679402575275),
        Vector3d(25.250104633250089, -2.2420525075685296, 24.219300654079557)}},
      {{{16.574118340170006, 1.1520922528354761e-07, 0.1596401576043511}},
       {Vector3d(6.6440927634382705, -1.6855816775976309e-08, 0.079820086885196137),
        Vector3d(6.644092797840969, 2.6889920008422484e-08, 0.079820086905739288),
        Vector3d(17.224793137649218, 10.318222768352559, 4.2827971092365065)}},
      {{{27.654271504564495, 5.9199322076329048e-07, 0.56932318913447388}},
       {Vector3d(9.2027494182875778, 1.6194623888125851e-07, 0.2846615971976415),
        Vector3d(9.202759526311814, -2.2872191957132697e-06, 0.28466334833836021),
        Vector3d(-1.7375000472487674, -8.8417630664831641, 5.3946616060045187)}},
      {{{58.022063176053734, 8.8222087413681513e-08, 0.76098902999225693}},
       {Vector3d(-25.116253838917327, -2.87901647715048e-08, 0.38049451887268221),
        Vector3d(-25.116243175989741, -1.4302066026713872e-06, 0.38049451887268221),
        Vector3d(-30.858032759559471, 11.781129637206865, 6.1872226123909746)}}};
  for (const auto& [box, sliver] : cases)
    EXPECT_FALSE(triangleWithinSolid(sliver, box, 0.0)) << box.size.transpose();
}

TEST(SphereContact, OfAHugeTriangleAndASmallSphereIsDecidedByTheirDistance)
{
  const std::uint64_t seed = 44;
  Features features(seed);
  const Sphere sphere{0.001};
  for (int i = 0; i < 300; ++i)
  {
    const double thin = std::pow(10.0, -(i % 9));
    const Triangle triangle = {Vector3d(-500, -100 * thin, 0), Vector3d(400, -150 * thin, 0),
                               Vector3d(50, 300 * thin, 0)};
    const Feature on_sphere = features.of(Shape(sphere), 0);
    const Feature on_triangle = features.of(triangle, i / 9 % 3);
    const double distance = pick(std::vector<double>{4.9e-10, 5.1e-10, 1e-9, 0.0}, i);
    const Isometry3d pose = placed(on_sphere, on_triangle, distance, 7.0 * features.share());
    EXPECT_EQ(distance < kSlack,
              triangleWithinSolid({pose * triangle[0], pose * triangle[1], pose * triangle[2]}, sphere, 0.0))
        << "seed " << seed << ", case " << i;
  }
}

std::string nameOf(const testing::TestParamInfo<int>& info)
{
  constexpr std::array<const char*, 6> kNames = {"Box", "Sphere", "Cylinder", "Cone", "Rod", "Plate"};
  return kNames[static_cast<std::size_t>(info.param)];
}
INSTANTIATE_TEST_SUITE_P(Solids, SolidContact, testing::Range(0, 6), nameOf);
}  // namespace
}  // namespace gpu_planning_scene::core
