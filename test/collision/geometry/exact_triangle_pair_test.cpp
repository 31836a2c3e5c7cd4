// Pairs of triangles of every kind at and near contact, compared with distances in 100-digit arithmetic. With this
// precision the signs of all expressions in a pair's double coordinates are certain.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "collision/geometry/triangle_pair.h"
#include "support/moving_shape.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;
using Number = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_100::backend_type,
                                             boost::multiprecision::et_off>;
using Point = std::array<Number, 3>;
using PrecisePair = std::array<std::array<Point, 3>, 2>;

Point operator-(const Point& a, const Point& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point along(const Point& start, const Number& t, const Point& step)
{
  return {start[0] + t * step[0], start[1] + t * step[1], start[2] + t * step[2]};
}
Number dot(const Point& a, const Point& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Number squared(const Point& a)
{
  return dot(a, a);
}

Number fromSegment(const Point& p, const Point& a, const Point& b)
{
  const Number length = squared(b - a);
  Number t = length > 0 ? Number(dot(p - a, b - a) / length) : Number(0);
  t = t < 0 ? Number(0) : t > 1 ? Number(1) : t;
  return squared(along(a, t, b - a) - p);
}

Number ofSegments(const Point& a, const Point& b, const Point& c, const Point& d)
{
  Number best = std::min({fromSegment(a, c, d), fromSegment(b, c, d), fromSegment(c, a, b), fromSegment(d, a, b)});
  // The minimum of |a + s u - c - t v|^2, from its normal equations by Cramer's rule.
  const Point u = b - a;
  const Point v = d - c;
  const Point w = c - a;
  const Number determinant = dot(u, u) * dot(v, v) - dot(u, v) * dot(u, v);
  if (determinant > 0)
  {
    const Number s = (dot(w, u) * dot(v, v) - dot(w, v) * dot(u, v)) / determinant;
    const Number t = (dot(w, u) * dot(u, v) - dot(w, v) * dot(u, u)) / determinant;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
      best = std::min(best, squared(along(a, s, u) - along(c, t, v)));
  }
  return best;
}

/// The smaller of `best` and the squared distance of a segment's end points from a triangle's face; 0 if the segment
/// passes through the face.
Number fromFace(const Point& start, const Point& end, const std::array<Point, 3>& t, Number best)
{
  const Point n = cross(t[1] - t[0], t[2] - t[0]);
  if (squared(n) == 0)
    return best;
  const auto above_face = [&](const Point& p)
  {
    for (int i = 0; i < 3; ++i)
      if (dot(cross(t[(i + 1) % 3] - t[i], p - t[i]), n) < 0)
        return false;
    return true;
  };
  const Number from = dot(start - t[0], n);
  const Number to = dot(end - t[0], n);
  for (const auto& [point, height] : {std::pair(start, from), std::pair(end, to)})
    if (above_face(point))
      best = std::min(best, Number(height * height / squared(n)));
  if ((from > 0) != (to > 0) && from != to && above_face(along(start, Number(from / (from - to)), end - start)))
    return 0;
  return best;
}

double trueDistance(const Triangle& a, const Triangle& b)
{
  PrecisePair pair;
  for (int i = 0; i < 3; ++i)
  {
    pair[0][i] = {a[i].x(), a[i].y(), a[i].z()};
    pair[1][i] = {b[i].x(), b[i].y(), b[i].z()};
  }
  Number best = squared(pair[0][0] - pair[1][0]);
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
      best = std::min(best, ofSegments(pair[0][i], pair[0][(i + 1) % 3], pair[1][j], pair[1][(j + 1) % 3]));
    best = fromFace(pair[0][i], pair[0][(i + 1) % 3], pair[1], best);
    best = fromFace(pair[1][i], pair[1][(i + 1) % 3], pair[0], best);
  }
  return static_cast<double>(sqrt(best));
}

/// Expects the same answer in every order of the vertices and triangles, and the true answer where the distance is not
/// too close to the limit.
void expectCanonical(const Triangle& p, const Triangle& q, double required, const std::string& what)
{
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  const bool answer = trianglesWithin(p, q, required);
  for (const auto& a : kOrders)
  {
    for (const auto& b : kOrders)
    {
      const Triangle p_again = {p[a[0]], p[a[1]], p[a[2]]};
      const Triangle q_again = {q[b[0]], q[b[1]], q[b[2]]};
      ASSERT_EQ(answer, trianglesWithin(p_again, q_again, required)) << what;
      ASSERT_EQ(answer, trianglesWithin(q_again, p_again, required)) << what;
    }
  }
  const double beyond = trueDistance(p, q) - (required + kSlack);
  if (std::abs(beyond) > 1e-12)
    ASSERT_EQ(answer, beyond < 0.0) << what << ", by " << beyond;
}

/// Two triangles that touch at the origin. The first lies in or below the plane z = 0, the second in or above it.
using Contact = std::array<Triangle, 2>;

class Contacts
{
 public:
  explicit Contacts(std::uint64_t seed) : generator_(seed) {}

  Contact next(int kind, double thin)
  {
    const Triangle face = {Vector3d(-0.4, -0.3, 0), Vector3d(0.5, -0.2, 0), Vector3d(-0.1, 0.6, 0)};
    const Triangle thin_face = {Vector3d(-0.7, -0.3 * thin, 0), Vector3d(0.8, -0.2 * thin, 0),
                                Vector3d(0.1, 0.5 * thin, 0)};
    const Triangle edge = {Vector3d(-0.6, 0, 0), Vector3d(0.7, 0, 0), Vector3d(share(), share(), -0.5)};
    const Triangle vertex = {Vector3d(0, 0, 0), Vector3d(share(), share(), -0.7), Vector3d(share(), share(), -0.4)};
    const Triangle tip_in_plane = {Vector3d(0, 0, 0), Vector3d(-0.5, 0.2, 0), Vector3d(-0.4, -0.3, 0)};
    const Triangle segment = {Vector3d(0, 0, 0), Vector3d(0, 0, -0.5), Vector3d(0, 0, -0.2)};
    const Triangle point = {Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0, 0)};
    switch (kind)
    {
      case 0:
        return {face, vertex};
      case 1:
        return {face, edge};
      case 2:  // two edges at an angle that may be small
        return {edge, turned(edge, thin)};
      case 3:
        return {edge, turned(edge, 1.1)};
      case 4:
        return {face, turned(face, 0.9)};  // overlapping in a plane
      case 5:
        return {thin_face, vertex};
      case 6:
        return {thin_face, turned(thin_face, 0.3)};
      case 7:  // nearly parallel planes
        return {face, Triangle{Vector3d(0, 0, 0), Vector3d(0.5, 0.1, -thin), Vector3d(0.2, 0.7, -thin)}};
      case 8:
        return {vertex, flipped(vertex)};
      case 9:
        return {face, segment};
      case 10:
        return {segment, flipped(segment)};
      case 11:
        return {thin_face, point};
      case 12:
        return {point, point};
      case 13:
        return {edge, tip_in_plane};
      default:  // a needle across a needle
        return {thin_face, Triangle{Vector3d(-0.1 * thin, 0.6, 0), Vector3d(0.2 * thin, 0.5, 0), Vector3d(0, -0.9, 0)}};
    }
  }
  static constexpr int kKinds = 15;

  double share() { return std::uniform_real_distribution<double>(-0.3, 0.3)(generator_); }
  std::mt19937_64& generator() { return generator_; }

 private:
  static Triangle turned(const Triangle& t, double angle)
  {
    const Eigen::AngleAxisd turn(angle, Vector3d::UnitZ());
    return flipped({turn * t[0], turn * t[1], turn * t[2]});
  }
  static Triangle flipped(const Triangle& t)
  {
    const Vector3d mirror(1, 1, -1);
    return {t[0].cwiseProduct(mirror), t[1].cwiseProduct(mirror), t[2].cwiseProduct(mirror)};
  }

  std::mt19937_64 generator_;
};

class ContactOfTriangles : public testing::TestWithParam<double>
{
};

// The parameter is the thickness of slivers and the angle of nearly parallel edges and planes.
TEST_P(ContactOfTriangles, IsDecidedByTheTrueDistanceInEveryOrder)
{
  constexpr std::array<double, 14> kOffsets = {0.0,      1e-3,  -1e-3,    1e-6,    -1e-6,  1e-9,  -1e-9,
                                               4.99e-10, 5e-10, 5.01e-10, 1.01e-9, -1e-10, 1e-12, -1e-12};
  const std::uint64_t seed = 31;
  Contacts contacts(seed);
  std::uniform_int_distribution<int> power(-4, 3);
  for (int i = 0; i < 1200; ++i)
  {
    const int kind = i % Contacts::kKinds;
    const Contact contact = contacts.next(kind, GetParam());
    const double scale = std::pow(10.0, power(contacts.generator()));
    const Eigen::Isometry3d pose = randomPose(contacts.generator(), i % 3 == 0 ? 1000.0 : scale);
    const double required = i % 4 == 1 ? 0.01 : 0.0;
    const Vector3d up(0, 0, required + kOffsets[static_cast<std::size_t>(i) % kOffsets.size()]);
    // The first triangle lies in or below the plane. The offset lifts the second one.
    Triangle p;
    Triangle q;
    for (int k = 0; k < 3; ++k)
    {
      p[k] = pose * Vector3d(scale * contact[0][k]);
      q[k] = pose * Vector3d(scale * contact[1][k] + up);
    }
    expectCanonical(p, q, required,
                    "seed " + std::to_string(seed) + ", pair " + std::to_string(i) + ", kind " + std::to_string(kind));
    if (HasFatalFailure())
      return;
  }
}
INSTANTIATE_TEST_SUITE_P(Thinness, ContactOfTriangles, testing::Values(0.5, 1e-3, 1e-5, 1e-7, 1e-9, 1e-12, 1e-16),
                         [](const auto& parameter)
                         { return "Ten" + std::to_string(std::lround(-std::log10(parameter.param))); });

TEST(ContactOfTriangles, AnyTwoTrianglesAreDecidedByTheTrueDistance)
{
  const std::uint64_t seed = 32;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  for (int i = 0; i < 1500; ++i)
  {
    std::array<Triangle, 2> pair;
    for (Triangle& triangle : pair)
    {
      const double size = std::pow(10.0, -2.0 * (i % 4));
      const Vector3d place(coordinate(generator), coordinate(generator), coordinate(generator));
      for (Vector3d& vertex : triangle)
        vertex = 0.5 * place + size * Vector3d(coordinate(generator), coordinate(generator), coordinate(generator));
    }
    const double distance = trueDistance(pair[0], pair[1]);
    for (const double required : {0.0, distance, distance - 1e-10, distance - 1e-9, distance - 1e-8, distance + 1e-8})
    {
      expectCanonical(pair[0], pair[1], std::max(0.0, required),
                      "seed " + std::to_string(seed) + ", pair " + std::to_string(i));
      if (HasFatalFailure())
        return;
    }
  }
}

TEST(ContactOfTriangles, SizesWhoseSquaresUnderflowAreDecidedByTheDistance)
{
  for (const double size : {1e-100, 1e-165, 1e-300})
  {
    const Triangle a = {Vector3d(0, 0, 0), Vector3d(size, 0, 0), Vector3d(0, size, 0)};
    for (const Vector3d& place : {Vector3d(0, 0, 0.005), Vector3d(0.003, 0.004, 0)})
    {
      const Triangle b = {place, place + Vector3d(size, 0, 0), place + Vector3d(0, size, size)};
      EXPECT_TRUE(trianglesWithin(a, b, 0.01)) << size;
      EXPECT_FALSE(trianglesWithin(a, b, 0.004)) << size;
    }
    const Triangle close = {Vector3d(2 * size, 0, size), Vector3d(3 * size, 0, 0), Vector3d(0, 4 * size, size)};
    EXPECT_TRUE(trianglesWithin(a, close, 0.0)) << size;
  }
}

TEST(ContactOfTriangles, ASliverThatPiercesDeeplyIsAHit)
{
  // The needle passes through the middle of a triangle that is 1e-5 m wide there, and beside it.
  const Triangle thin = {Vector3d(-1, 0, 0), Vector3d(1, -1e-5, 0), Vector3d(1, 1e-5, 0)};
  const auto needle = [](double y) { return Triangle{Vector3d(0, y, -1), Vector3d(0, y, 1), Vector3d(0, y, 3)}; };
  expectCanonical(thin, needle(0.0), 0.0, "through");
  expectCanonical(thin, needle(4.9e-6), 0.0, "near the edge");
  expectCanonical(thin, needle(5.1e-6), 0.0, "beside");
  EXPECT_TRUE(trianglesWithin(thin, needle(4.9e-6), 0.0));
  EXPECT_FALSE(trianglesWithin(thin, needle(5.1e-6), 0.0));
}
}  // namespace
}  // namespace gpu_planning_scene::core
