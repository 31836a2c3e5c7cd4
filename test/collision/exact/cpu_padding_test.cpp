// Required distances of shapes and half-spaces in the exact checker.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/moving_shape.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr std::array<double, 8> kOffsets = {1e-3, 1e-5, 1e-7, 1e-8, -1e-3, -1e-5, -1e-7, -1e-8};

std::shared_ptr<const Mesh> meshOf(const Shape& shape)
{
  return tessellate(shape).mesh;
}

/// Checks padded and bare pairs near their limit. The distance of the pair is `gap` when the moving shape's pose is
/// `from` moved by gap * direction.
void expectPadded(const Shape& moving, const Shape& object, const Eigen::Isometry3d& from, const Vector3d& direction,
                  const std::string& what)
{
  const PairPadding padding{0.03, 0.02};
  const double required = padding.moving + padding.objects;
  std::mt19937_64 generator(61);
  for (const Eigen::Isometry3d& place : {at(0, 0, 0), randomPose(generator, 1.0), randomPose(generator, 900.0)})
  {
    MovingShape padded(moving, {{object, place}}, padding);
    MovingShape bare(moving, {{object, place}});
    const auto pose_at = [&](double gap)
    { return place * Eigen::Isometry3d(Eigen::Translation3d(gap * direction.normalized())) * from; };
    for (const double offset : kOffsets)
    {
      EXPECT_EQ(offset < 0.0, padded.collides(pose_at(required + offset))) << what << ", by " << offset;
      EXPECT_EQ(offset < -1e-9, padded.collides(pose_at(required + offset + 1.1e-9))) << what << ", by " << offset;
    }
    EXPECT_TRUE(padded.collides(pose_at(required))) << what;
    EXPECT_FALSE(bare.collides(pose_at(1.1e-9))) << what;
    EXPECT_TRUE(bare.collides(pose_at(0.0))) << what;
  }
}

/// Runs expectPadded() for primitives and meshes in all combinations.
void expectPaddedAsAnything(const Shape& moving, const Shape& object, const Eigen::Isometry3d& from,
                            const Vector3d& direction, const std::string& what)
{
  expectPadded(moving, object, from, direction, what);
  expectPadded(meshOf(moving), object, from, direction, what + ", mesh and primitive");
  expectPadded(moving, meshOf(object), from, direction, what + ", primitive and mesh");
  expectPadded(meshOf(moving), meshOf(object), from, direction, what + ", meshes");
}

TEST(CpuPadding, IsADistanceOfFacesEdgesAndCorners)
{
  const Box small{{0.2, 0.2, 0.2}};
  const Box large{{1.0, 1.0, 1.0}};
  expectPaddedAsAnything(small, large, at(0.6, 0.1, 0.2), Vector3d(1, 0, 0), "faces");
  expectPaddedAsAnything(small, large, at(0.6, 0.6, 0.2), Vector3d(1, 1, 0), "edges");
  expectPaddedAsAnything(small, large, at(0.6, 0.6, 0.6), Vector3d(1, 2, 3), "corners");
}

TEST(CpuPadding, IsADistanceOfCurvedSurfaces)
{
  const Box table{{1.0, 1.0, 0.1}};
  expectPadded(Sphere{0.1}, table,
               at(0.5 + 0.1 / std::sqrt(3.0), 0.5 + 0.1 / std::sqrt(3.0), 0.05 + 0.1 / std::sqrt(3.0)),
               Vector3d(1, 1, 1), "sphere at a corner");
  expectPadded(Cylinder{0.1, 0.4}, meshOf(table), at(0.1, 0.1, 0.25), Vector3d(0, 0, 1), "cylinder on a mesh");
  expectPadded(Cone{0.1, 0.4}, Cylinder{0.2, 0.3}, at(0.05, 0.0, 0.35), Vector3d(0, 0, 1), "cone on a cylinder");
  expectPadded(Sphere{0.1}, meshOf(table), at(0.0, 0.5 + 0.06, 0.05 + 0.08), Vector3d(0, 3, 4), "sphere at an edge");
}

TEST(CpuPadding, DoesNotCountBetweenLinks)
{
  auto problem = std::make_shared<CollisionProblem>();
  problem->shapes = {Box{{1, 1, 1}}};
  problem->tessellations = {tessellate(problem->shapes[0])};
  problem->robot = {{0, 0, 0, Eigen::Isometry3d::Identity(), 0.1}, {0, 1, 1, Eigen::Isometry3d::Identity(), 0.1}};
  problem->self_pairs = {{0, 1}};
  const ExactChecker exact(problem, std::make_shared<const Forest>(buildBinnedSah(problem->tessellations)));
  ExactChecker::Scratch scratch;
  // The links are rotated, so that their axis-aligned boxes overlap.
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  for (const double gap : {0.0, 0.05, 1e-8})
  {
    const std::array<Eigen::Isometry3d, 2> poses = {turn, turn * at(1.0 + gap, 0.2, 0.2)};
    EXPECT_EQ(gap == 0.0, exact.firstCollision(poses.data(), scratch).has_value()) << gap;
  }
}

/// The extent of the shape along a unit vector, from the origin of its frame.
double reach(const Shape& shape, const Vector3d& n)
{
  const double across = n.head<2>().norm();
  if (const auto* box = std::get_if<Box>(&shape))
    return 0.5 * box->size.dot(n.cwiseAbs());
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return sphere->radius;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return cylinder->radius * across + 0.5 * cylinder->length * std::abs(n.z());
  if (const auto* cone = std::get_if<Cone>(&shape))
    return std::max(0.5 * cone->length * n.z(), cone->radius * across - 0.5 * cone->length * n.z());
  double most = -std::numeric_limits<double>::infinity();
  for (const Vector3d& vertex : std::get<std::shared_ptr<const Mesh>>(shape)->vertices)
    most = std::max(most, n.dot(vertex));
  return most;
}

TEST(HalfSpaces, AreMetByWhateverReachesThePlaneOrIsBelowIt)
{
  const std::uint64_t seed = 62;
  std::mt19937_64 generator(seed);
  const PairPadding padding{0.01, 0.03};
  for (const Shape& shape : {Shape(Box{{0.2, 0.1, 0.3}}), Shape(Sphere{0.1}), Shape(Cylinder{0.1, 0.3}),
                             Shape(Cone{0.1, 0.3}), Shape(meshOf(Cone{0.1, 0.3}))})
  {
    for (int i = 0; i < 20; ++i)
    {
      const Eigen::Isometry3d plane = randomPose(generator, i % 2 == 0 ? 1.0 : 900.0);
      const HalfSpace half_space{Vector3d::UnitZ(), 0.2};
      MovingShape bare(shape, {{half_space, plane}});
      MovingShape padded(shape, {{half_space, plane}}, padding);
      const Eigen::Isometry3d turn = randomPose(generator, 0.0);
      const double lowest = -reach(shape, turn.linear().transpose() * -Vector3d::UnitZ());
      const auto pose_at = [&](double height) { return plane * at(0.3, -0.2, 0.2 + height - lowest) * turn; };
      const std::string what = "seed " + std::to_string(seed) + ", kind " + std::to_string(shape.index());
      EXPECT_TRUE(bare.collides(pose_at(0.0))) << what;
      EXPECT_FALSE(bare.collides(pose_at(1.1e-9))) << what;
      EXPECT_TRUE(bare.collides(pose_at(-1e-9))) << what;
      EXPECT_TRUE(bare.collides(pose_at(-50.0))) << what << ", far below";
      EXPECT_TRUE(padded.collides(pose_at(0.04))) << what;
      EXPECT_FALSE(padded.collides(pose_at(0.04 + 1.1e-9))) << what;
      EXPECT_TRUE(padded.collides(pose_at(0.04 - 1e-9))) << what;
    }
  }
}

TEST(HalfSpaces, AreCheckedForTheChosenPairsAndNamed)
{
  MovingShape pairs(Sphere{0.1}, {{Box{{1, 1, 1}}, at(5, 0, 0)}, {HalfSpace{Vector3d::UnitZ(), 0.0}}});
  EXPECT_EQ((std::vector<BodyPair>{{0, 2}}), pairs.all(at(0, 0, 0)));
  EXPECT_EQ((std::vector<BodyPair>{{0, 1}, {0, 2}}), pairs.all(at(5, 0, 0)));
  EXPECT_EQ((std::vector<BodyPair>{{0, 1}}), pairs.all(at(5, 0, 0.3)));
}
}  // namespace
}  // namespace gpu_planning_scene::core
