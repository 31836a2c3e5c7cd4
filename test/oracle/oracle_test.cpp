// Tests the oracle against distances that are known in closed form, also after random rigid motions.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "oracle/oracle.h"
#include "oracle/triangle.h"

using namespace gpu_planning_scene::core;
using oracle::Motion;
using oracle::PreparedShape;
using oracle::Verdict;

namespace
{
constexpr double kPi = 3.14159265358979323846;

std::shared_ptr<const Mesh> makeMesh(std::vector<Eigen::Vector3d> vertices,
                                     std::vector<std::array<std::uint32_t, 3>> triangles)
{
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices = std::move(vertices);
  mesh->triangles = std::move(triangles);
  return mesh;
}

Shape triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return makeMesh({a, b, c}, {{0, 1, 2}});
}

Shape boxMesh(double size, bool inverted = false)
{
  auto mesh = std::make_shared<Mesh>(*tessellate(Box{Eigen::Vector3d::Constant(size)}).mesh);
  for (auto& t : mesh->triangles)
    if (inverted)
      std::swap(t[0], t[1]);
  return std::shared_ptr<const Mesh>(mesh);
}

/// A box with a second, inverted box inside: a solid with a cavity.
Shape hollowBox(double outer, double inner)
{
  auto mesh = std::make_shared<Mesh>(*std::get<std::shared_ptr<const Mesh>>(boxMesh(outer)));
  const auto shell = std::get<std::shared_ptr<const Mesh>>(boxMesh(inner, true));
  const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
  mesh->vertices.insert(mesh->vertices.end(), shell->vertices.begin(), shell->vertices.end());
  for (const auto& t : shell->triangles)
    mesh->triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return std::shared_ptr<const Mesh>(mesh);
}

Eigen::Isometry3d shift(double x, double y, double z)
{
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

Eigen::Isometry3d turn(double angle, const Eigen::Vector3d& axis)
{
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle, axis.normalized()));
}

Motion randomMotion(std::mt19937_64& random, double distance)
{
  std::normal_distribution<double> normal;
  Eigen::Isometry3d pose(
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized());
  pose.translation() = distance * Eigen::Vector3d(normal(random), normal(random), normal(random));
  return Motion(pose);
}

/// Expects that b, placed in a's frame, is at distance `expected`, to `tolerance`. Checks the pair in place and after
/// random motions of both shapes, also a kilometre away, and with the arguments swapped.
void expectDistance(const Shape& a, const Shape& b, const Eigen::Isometry3d& b_in_a, double expected,
                    double tolerance = 3e-13)
{
  const PreparedShape first(a);
  const PreparedShape second(b);
  std::mt19937_64 random(7);
  for (const double away : {0.0, 1.0, 1000.0})
  {
    const Motion pose_a = away > 0.0 ? randomMotion(random, away) : Motion();
    const Motion pose_b = pose_a * Motion(b_in_a);
    EXPECT_NEAR(oracle::distance(first, pose_a, second, pose_b), expected, tolerance) << away << " m away";
    EXPECT_NEAR(oracle::distance(second, pose_b, first, pose_a), expected, tolerance) << away << " m away, swapped";
    for (const double over : {-1e-6, -1e-11, 0.5e-9, 2e-9, 1e-3})
    {
      if (expected - over < 0.0)
        continue;
      const Verdict verdict = over <= 0.0 ? Verdict::Collides : over < 1e-9 ? Verdict::Either : Verdict::Free;
      EXPECT_EQ(oracle::verdict(first, pose_a, second, pose_b, expected - over), verdict) << over;
    }
  }
}

const Shape kFlat = triangle({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
}  // namespace

TEST(Oracle, SquareRootAndSineAreOfQuadruplePrecision)
{
  for (const double x : {2.0, 1e-300, 3e200, 0.7})
  {
    const oracle::Quad value = oracle::Quad(x) * oracle::Quad(x < 1.0 ? 1e-200 : 1.0);
    const oracle::Quad root = oracle::sqrt(value);
    EXPECT_LT(static_cast<double>(oracle::abs(root * root / value - 1)), 1e-33) << x;
  }
  for (const double angle : {0.0, 0.3, 0.8, -2.0, 3.0, 40.0, -1e5})
  {
    const auto [sine, cosine] = oracle::sineCosine(angle);
    EXPECT_NEAR(static_cast<double>(sine), std::sin(angle), 2e-16);
    EXPECT_NEAR(static_cast<double>(cosine), std::cos(angle), 2e-16);
    EXPECT_LT(static_cast<double>(oracle::abs(sine * sine + cosine * cosine - 1)), 1e-32);
    const auto twice = oracle::sineCosine(oracle::Quad(angle) * 2);
    EXPECT_LT(static_cast<double>(oracle::abs(twice.sine - 2 * sine * cosine)), 1e-27 * (1.0 + std::abs(angle)));
  }
}

TEST(Oracle, PosesBecomeRotations)
{
  std::mt19937_64 random(3);
  const Motion motion = randomMotion(random, 1.0);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(static_cast<double>(oracle::abs(dot(motion.rows[i], motion.rows[k]) - (i == k ? 1 : 0))), 1e-33);
}

TEST(Oracle, TrianglesAtKnownDistances)
{
  const double d = 0.125;
  expectDistance(kFlat, kFlat, shift(0.2, 0.2, d), d);                                                  // face, face
  expectDistance(kFlat, triangle({0.2, 0.2, d}, {0.3, 0.2, 1.0}, {0.2, 0.4, 1.0}), shift(0, 0, 0), d);  // vertex, face
  expectDistance(kFlat, triangle({0.5, -1, d}, {0.5, 2, d}, {0.5, 0, 3}), shift(0, 0, 0), d);           // edge, face
  expectDistance(kFlat, triangle({-1, -d, 0.5}, {2, -d, -0.5}, {2, -3, 0}), shift(0, 0, 0), d);         // edge, edge
  expectDistance(kFlat, triangle({1 + d, 0, 0}, {3, 0, 1}, {3, 1, 0}), shift(0, 0, 0), d);             // vertex, vertex
  expectDistance(kFlat, triangle({-d, -1, 0}, {-d, 3, 0}, {-2, 0, 0}), shift(0, 0, 0), d);             // in a plane
  expectDistance(kFlat, triangle({0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.3, 0.2, 1}), shift(0, 0, 0), 0.0);  // pierced
  expectDistance(kFlat, kFlat, shift(0.1, 0.1, 0), 0.0);                                               // overlapping
  expectDistance(kFlat, triangle({0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.1, 0.2, 0}), shift(0, 0, 0), 0.0);   // contained
  expectDistance(kFlat, triangle({0, 0, 0}, {-1, 0, 0}, {0, 0, 1}), shift(0, 0, 0), 0.0);  // a common vertex
}

TEST(Oracle, BoundsInDoubleAreBelowTheDistanceOfTriangles)
{
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const auto near = [&](const Eigen::Vector3d& center, double size)
  { return Eigen::Vector3d(center + size * Eigen::Vector3d(normal(random), normal(random), normal(random))); };
  const auto exact = [](const oracle::TriangleCorners& t) {
    return oracle::Triangle({oracle::Vector(t[0]), oracle::Vector(t[1]), oracle::Vector(t[2])});
  };
  std::size_t apart = 0;
  std::size_t tight = 0;
  for (int i = 0; i < 20000; ++i)
  {
    // From touching triangles to distant ones, from 10 metres across to slivers, also a kilometre from the origin.
    const Eigen::Vector3d center = near({0, 0, 0}, i % 3 == 0 ? 1000.0 : 1.0);
    const double thickness = std::pow(10.0, -(i % 17));
    oracle::TriangleCorners a;
    oracle::TriangleCorners b;
    for (oracle::TriangleCorners* t : {&a, &b})
    {
      const double offset = t == &b ? std::pow(10.0, -(i % 11)) : 0.0;
      (*t)[0] = near(center, 1.0) + Eigen::Vector3d(0, 0, offset);
      (*t)[1] = near((*t)[0], 10.0);
      (*t)[2] = near((*t)[1], thickness);
    }
    if (i % 5 == 0)
      b = {a[1], a[2] + Eigen::Vector3d(0, 0, thickness), a[0]};  // an edge, or nearly, in common
    const oracle::Quad distance = oracle::distance(exact(a), exact(b), 1e6);
    const double bound = oracle::leastDistance(a, b);
    EXPECT_LE(bound, distance) << i;
    if (distance > 0)
    {
      ++apart;
      tight += bound > distance - 1e-9 ? 1 : 0;
    }
  }
  EXPECT_GT(apart, 10000U);
  EXPECT_GT(tight, apart * 9 / 10);
  for (const double height : {1e-155, 1e-158, 1e-161})  // the squares of such numbers underflow
    EXPECT_LE(oracle::leastDistance({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, height, 0), {1, 2 * height, 0}},
                                    {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, height, 1), {1, 2 * height, 1}}),
              1.0);
}

/// Corners of such meshes are rounded by 1e-10 m when they are moved in double.
TEST(Oracle, MeshesFarFromTheirOriginsHaveTheDistanceOfNearOnes)
{
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d offset(1048576.0, -524288.0, 262144.0);  // sums with small binary fractions are exact
  for (int i = 0; i < 300; ++i)
  {
    std::array<std::vector<Eigen::Vector3d>, 2> corners;
    for (int k = 0; k < 6; ++k)
    {
      const Eigen::Vector3d at(normal(random), normal(random), normal(random) + (k < 3 ? 0.0 : 1.0));
      corners[k / 3].emplace_back((at * 1024.0).array().round().matrix() / 1024.0);
    }
    const auto mesh = [&](int m, const Eigen::Vector3d& by)
    { return triangle(corners[m][0] + by, corners[m][1] + by, corners[m][2] + by); };
    const PreparedShape a(mesh(0, {0, 0, 0}));
    const Motion turn = randomMotion(random, 0.0);
    Motion shifted = turn;
    shifted.translation = turn.rotate(oracle::Vector(Eigen::Vector3d(-offset)));
    const double near = oracle::distance(a, {}, PreparedShape(mesh(1, {0, 0, 0})), turn);
    const double far = oracle::distance(a, {}, PreparedShape(mesh(1, offset)), shifted);
    EXPECT_NEAR(near, far, 1e-15 + 1e-15 * near) << i;
  }
}

TEST(Oracle, TrianglesWithoutAreaAreSegmentsAndPoints)
{
  expectDistance(kFlat, triangle({0.25, 0.25, 0.5}, {0.25, 0.25, 0.5}, {0.25, 0.25, 0.5}), shift(0, 0, 0), 0.5);
  expectDistance(kFlat, triangle({0.25, 0.25, 0.5}, {0.25, 0.25, 1.5}, {0.25, 0.25, 1.0}), shift(0, 0, 0), 0.5);
  expectDistance(kFlat, triangle({0.25, 0.25, -1.0}, {0.25, 0.25, 1.5}, {0.25, 0.25, 1.0}), shift(0, 0, 0), 0.0);
  const Shape segment = triangle({0, 0, 0}, {1, 0, 0}, {0.5, 0, 0});
  expectDistance(segment, segment, shift(0.0, 0.5, 0.0), 0.5);
  // A sliver: its face counts at any thickness.
  for (const double thin : {1e-3, 1e-7, 1e-12})
    expectDistance(triangle({-1, -thin, 0}, {1, -thin, 0}, {0, thin, 0}), triangle({0, 0, 0.25}, {1, 0, 1}, {-1, 0, 1}),
                   shift(0, 0, 0), 0.25);
}

TEST(Oracle, SpheresAndBoxes)
{
  const Shape box = Box{{2.0, 2.0, 2.0}};
  expectDistance(Sphere{0.5}, Sphere{0.25}, shift(3.0, 4.0, 0.0), 4.25);
  expectDistance(Sphere{0.5}, Sphere{0.25}, shift(0.1, 0.0, 0.0), 0.0);
  expectDistance(box, Sphere{0.25}, shift(2.0, 0.5, 0.0), 0.75);
  expectDistance(box, Sphere{0.25}, shift(2.0, 2.0, 2.0), std::sqrt(3.0) - 0.25);
  expectDistance(box, Sphere{0.25}, shift(0.1, 0.0, 0.0), 0.0);
  expectDistance(box, box, shift(2.5, 1.0, 0.0), 0.5);
  // An edge faces an edge: half a diagonal is sqrt 2.
  const Eigen::Isometry3d edge_up = shift(2.5 + std::sqrt(2.0), 0, 0) * turn(0.25 * kPi, Eigen::Vector3d::UnitZ());
  expectDistance(box, box, edge_up, 1.5);
}

TEST(Oracle, CylindersAndCones)
{
  const Shape cylinder = Cylinder{0.5, 2.0};
  const Shape cone = Cone{1.0, 2.0};
  const Eigen::Isometry3d lying = turn(0.5 * kPi, Eigen::Vector3d::UnitX());
  expectDistance(cylinder, cylinder, shift(2.0, 0.0, 0.5), 1.0);                   // parallel
  expectDistance(cylinder, cylinder, shift(2.0, 0.0, 0.5) * lying, 1.0);           // crossed
  expectDistance(cylinder, cylinder, shift(0.1, 0.2, 2.25), 0.25);                 // caps
  expectDistance(cylinder, cylinder, shift(0.3, 0.0, 1.75) * lying, 0.25);         // side on cap
  expectDistance(cylinder, cylinder, shift(3.0, 4.0, 4.0), std::hypot(4.0, 2.0));  // rims
  expectDistance(cylinder, Sphere{0.25}, shift(3.0, 4.0, 0.0), 4.25);
  expectDistance(cylinder, Sphere{0.25}, shift(0.6, 0.8, 2.0), std::hypot(0.5, 1.0) - 0.25);
  expectDistance(cylinder, Box{{1.0, 1.0, 1.0}}, shift(1.75, 0.0, 0.0), 0.75);
  expectDistance(cone, Sphere{0.25}, shift(0.0, 0.0, 2.0), 0.75);  // above the apex
  // Beside the slant, whose outward normal is (2, 0, 1) / sqrt 5.
  expectDistance(cone, Sphere{0.25}, shift(0.5 + 2.0 / std::sqrt(5.0), 0.0, 1.0 / std::sqrt(5.0)), 0.75);
  expectDistance(cone, cone, shift(0.0, 0.0, 2.5) * turn(kPi, Eigen::Vector3d::UnitX()), 0.5);   // apexes
  expectDistance(cone, cone, shift(0.0, 0.0, -2.5) * turn(kPi, Eigen::Vector3d::UnitX()), 0.5);  // bases
  expectDistance(cylinder, cone, shift(0.1, 0.0, 0.2), 0.0);
  expectDistance(kFlat, cylinder, shift(0.25, 0.25, 1.5), 0.5);
  expectDistance(kFlat, cylinder, shift(-1.0, 0.5, 0.0) * lying, 0.5);
  expectDistance(kFlat, cone, shift(0.25, 0.25, -1.5), 0.5);
  expectDistance(kFlat, cylinder, shift(0.25, 0.25, 0.5), 0.0);
}

TEST(Oracle, GrazingCurvesAreDecidedToTheirAccuracy)
{
  // Two crossed cylinders that almost touch or just overlap.
  const PreparedShape cylinder(Cylinder{0.5, 2.0});
  const Motion lying(turn(0.5 * kPi, Eigen::Vector3d::UnitX()));
  for (const double gap : {1e-3, 1e-6, 2e-9, 5e-10, 1e-11, -1e-11, -1e-9, -1e-5})
  {
    Motion other = lying;
    other.translation = {oracle::Quad(1) + oracle::Quad(gap), 0, oracle::Quad(0.3)};
    EXPECT_NEAR(oracle::distance(cylinder, {}, cylinder, other), std::max(0.0, gap), 3e-13);
    const Verdict expected = gap < 0 ? Verdict::Collides : gap < 1e-9 ? Verdict::Either : Verdict::Free;
    EXPECT_EQ(oracle::verdict(cylinder, {}, cylinder, other, 0.0), expected) << gap;
  }
}

TEST(Oracle, HalfSpaces)
{
  const Shape ground = HalfSpace{Eigen::Vector3d::UnitZ(), 0.25};
  expectDistance(ground, Sphere{0.5}, shift(3.0, 1.0, 1.0), 0.25);
  expectDistance(ground, Cylinder{0.5, 2.0}, shift(3.0, 1.0, 1.0) * turn(0.5 * kPi, Eigen::Vector3d::UnitX()), 0.25);
  expectDistance(ground, Cone{0.5, 2.0}, shift(0.0, 0.0, 1.5), 0.25);
  expectDistance(ground, Cone{0.5, 2.0}, shift(0.0, 0.0, 1.5) * turn(kPi, Eigen::Vector3d::UnitX()), 0.25);
  expectDistance(ground, kFlat, shift(0.0, 0.0, 0.5) * turn(0.5 * kPi, Eigen::Vector3d::UnitX()), 0.25);
  expectDistance(ground, boxMesh(1.0), shift(0.0, 0.0, -40.0), 0.0);
}

TEST(Oracle, ClosedMeshesAreSolids)
{
  expectDistance(boxMesh(2.0), boxMesh(1.0), shift(0.1, 0.2, 0.0), 0.0);
  expectDistance(boxMesh(2.0), boxMesh(1.0), shift(1.75, 0.0, 0.0), 0.25);
  expectDistance(boxMesh(2.0, true), boxMesh(1.0), shift(0.1, 0.2, 0.0), 0.0);
  expectDistance(boxMesh(2.0), Sphere{0.25}, shift(0.1, 0.2, 0.0), 0.0);
  expectDistance(boxMesh(2.0), Sphere{0.25}, shift(0.1, 0.2, 1.75), 0.5);
  expectDistance(Sphere{4.0}, boxMesh(2.0), shift(0.1, 0.2, 0.0), 0.0);
  expectDistance(boxMesh(2.0), triangle({0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}), shift(0.1, 0.2, 0.3), 0.0);
}

TEST(Oracle, OpenMeshesAndCavitiesAreEmpty)
{
  auto open = std::make_shared<Mesh>(*std::get<std::shared_ptr<const Mesh>>(boxMesh(2.0)));
  open->triangles.resize(10);  // a box without one of its faces
  expectDistance(std::shared_ptr<const Mesh>(open), boxMesh(1.0), shift(0.0, 0.0, 0.0), 0.5);
  // As many triangles as before, two of them twice.
  open->triangles.push_back(open->triangles[0]);
  open->triangles.push_back(open->triangles[1]);
  expectDistance(std::shared_ptr<const Mesh>(open), boxMesh(1.0), shift(0.0, 0.0, 0.0), 0.5);
  expectDistance(hollowBox(3.0, 2.0), boxMesh(1.0), shift(0.25, 0.0, 0.0), 0.25);
  expectDistance(hollowBox(3.0, 2.0), Sphere{0.5}, shift(0.25, 0.0, 0.0), 0.25);
  expectDistance(hollowBox(3.0, 1.0), boxMesh(0.25), shift(1.0, 0.0, 0.0), 0.0);
  // Two shells with the same orientation: the winding number inside is 2, so there is no cavity.
  auto twice = std::make_shared<Mesh>(*std::get<std::shared_ptr<const Mesh>>(hollowBox(3.0, 2.0)));
  for (std::size_t i = 12; i < 24; ++i)
    std::swap(twice->triangles[i][0], twice->triangles[i][1]);
  expectDistance(std::shared_ptr<const Mesh>(twice), boxMesh(1.0), shift(0.25, 0.0, 0.0), 0.0);
}
