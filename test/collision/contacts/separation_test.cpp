// Moving the second body by a contact's depth along its normal ends the collision, and contact points lie on both
// bodies. The oracle and brute force over directions tell what is right.

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/math_constants.h"
#include "collision/contacts/colliding_shapes.h"
#include "collision/contacts/held_shape.h"
#include "collision/geometry/primitive_solid.h"
#include "oracle/oracle.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kOnBody = 1e-6;  // metres

double reach(const Shape& shape, const Isometry3d& pose, const Vector3d& direction)
{
  const Vector3d local = pose.linear().transpose() * direction;
  const double offset = direction.dot(pose.translation());
  if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape))
  {
    double most = -1e9;
    for (const Vector3d& vertex : (*mesh)->vertices)
      most = std::max(most, local.dot(vertex));
    return offset + most;
  }
  return offset + reachAlong(shape, local);
}

/// The least overlap of two convex shapes over many directions; an upper bound of the penetration depth.
double depthByBruteForce(const Shape& a, const Isometry3d& pose_a, const Shape& b, const Isometry3d& pose_b,
                         Random& random)
{
  const auto overlap = [&](const Vector3d& normal) { return reach(a, pose_a, normal) + reach(b, pose_b, -normal); };
  double best = std::numeric_limits<double>::infinity();
  for (int start = 0; start < 30; ++start)
  {
    Vector3d normal = randomDirection(random);
    double depth = overlap(normal);
    for (double step = 0.5; step > 1e-7; step *= 0.8)
      for (int i = 0; i < 6; ++i)
      {
        const Vector3d tried = (normal + step * randomDirection(random)).normalized();
        const double found = overlap(tried);
        if (found >= depth)
          continue;
        depth = found;
        normal = tried;
      }
    best = std::min(best, depth);
  }
  return best;
}

void expectSeparation(const Kind& held_kind, const Kind& object_kind, std::size_t scenes, std::size_t poses,
                      double padding = 0.0)
{
  SCOPED_TRACE(held_kind.name + " in " + object_kind.name + ", seed " + std::to_string(kSeed));
  Random random(kSeed);
  std::size_t found = 0;
  for (std::size_t scene = 0; scene < scenes; ++scene)
  {
    const Shape held_shape = held_kind.make(random);
    const PlacedShape object = {object_kind.make(random), randomPose(random, 1.0)};
    const HeldShape held(held_shape, {object}, padding);
    const StateInspector inspector = held.inspector();
    const oracle::PreparedShape prepared_held(held_shape);
    const oracle::PreparedShape prepared_object(object.shape);
    CollidingPoses colliding(held_shape, {object}, padding, kSeed + scene);
    for (std::size_t i = 0; i < poses; ++i)
    {
      const auto pose = colliding.next();
      if (!pose)
        continue;
      SCOPED_TRACE("scene " + std::to_string(scene) + ", pose " + std::to_string(i));
      const auto contacts = inspector.contacts(HeldShape::state(*pose).data(), "", 20, 0);
      ASSERT_FALSE(contacts.empty());
      ++found;
      // Bodies that only miss their padding have no common point.
      const double distance =
          padding > 0.0 ? oracle::distance(prepared_object, motionOf(object.pose), prepared_held, motionOf(*pose))
                        : 0.0;
      for (const Contact& contact : contacts)
      {
        ASSERT_GE(contact.depth, 0.0);
        ASSERT_NEAR(contact.normal.norm(), 1.0, 1e-9);
        ASSERT_LE(distanceTo(prepared_object, object.pose, contact.point), kOnBody + 0.5 * distance);
        ASSERT_LE(distanceTo(prepared_held, *pose, contact.point), kOnBody + 0.5 * distance);
      }
      const Contact& deepest = contacts.front();
      Isometry3d moved = *pose;
      moved.pretranslate(deepest.depth * deepest.normal);
      ASSERT_EQ(oracle::Verdict::Free,
                oracle::verdict(prepared_object, motionOf(object.pose), prepared_held, motionOf(moved), padding))
          << "depth " << deepest.depth << " along " << deepest.normal.transpose();
      ASSERT_TRUE(inspector.contacts(HeldShape::state(moved).data(), "", 1, 0).empty());
      if (!held_kind.is_convex || !object_kind.is_convex)
        continue;
      const double overlap = depthByBruteForce(object.shape, object.pose, held_shape, *pose, random);
      ASSERT_LE(deepest.depth, padding + std::max(0.0, overlap) + 2e-7);
    }
  }
  EXPECT_GT(found, scenes * poses / 4);
}

TEST(Separation, OfEachKindOfShapesEndsTheCollisionAtAPointOfBoth)
{
  for (const Kind& held : kinds())
    for (const Kind& object : kinds())
    {
      expectSeparation(held, object, repetitions(1, 50), repetitions(6, 200));
      if (HasFatalFailure())
        return;
    }
}

TEST(Separation, OfPaddedShapesEndsTheCollisionBetweenTheirNearestPoints)
{
  for (const Kind& held : kinds())
    for (const Kind& object : kinds())
    {
      if (held.is_convex != object.is_convex)
        continue;
      expectSeparation(held, object, 1, repetitions(3, 200), 0.02);
      if (HasFatalFailure())
        return;
    }
}

TEST(Separation, OfAHalfSpaceIsAlongItsNormal)
{
  const Kind half_space = halfSpaces();
  for (const Kind& held : kinds())
  {
    Random random(kSeed);
    const HalfSpace plane = std::get<HalfSpace>(half_space.make(random));
    const Shape shape = held.make(random);
    const HeldShape scene(shape, {{plane, Isometry3d::Identity()}});
    const StateInspector inspector = scene.inspector();
    CollidingPoses colliding(shape, {{plane, Isometry3d::Identity()}}, 0.0, kSeed);
    SCOPED_TRACE(held.name + ", seed " + std::to_string(kSeed));
    for (int i = 0; i < repetitions(20, 10000); ++i)
    {
      const auto pose = colliding.next();
      ASSERT_TRUE(pose.has_value());
      const auto contacts = inspector.contacts(HeldShape::state(*pose).data(), "", 20, 0);
      ASSERT_EQ(1u, contacts.size());
      const Contact& contact = contacts.front();
      const double overlap = plane.offset + reach(shape, *pose, -plane.normal);
      EXPECT_NEAR(contact.depth, std::max(0.0, overlap), 1e-8);
      EXPECT_GE(contact.depth, 0.0);
      EXPECT_LT((contact.normal - plane.normal).norm(), 1e-9);
      EXPECT_LE(plane.normal.dot(contact.point) - plane.offset, kOnBody);
      EXPECT_LE(distanceTo(oracle::PreparedShape(shape), *pose, contact.point), kOnBody);
      Isometry3d moved = *pose;
      moved.pretranslate(contact.depth * contact.normal);
      EXPECT_TRUE(inspector.contacts(HeldShape::state(moved).data(), "", 1, 0).empty());
    }
  }
}

/// The angle of two unit vectors, in degrees.
double degreesBetween(const Vector3d& a, const Vector3d& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / kPi;
}

TEST(Separation, OfACylinderOnACubeMeshIsAlongTheFace)
{
  const HeldShape held(Cylinder{0.05, 0.1}, {{tessellate(Box{{1.0, 1.0, 1.0}}).mesh, Isometry3d::Identity()}});
  const auto contacts = held.contacts({0.53, 0.0, 0.0});
  ASSERT_GE(contacts.size(), 2u);
  for (const Contact& contact : contacts)
  {
    EXPECT_LT((contact.normal - Vector3d::UnitX()).norm(), 1e-6) << "from the cube to the cylinder";
    EXPECT_NEAR(contact.depth, 0.02, 1e-8);
    EXPECT_LE(contact.point.x(), 0.5 + 1e-6);
    EXPECT_GE(contact.point.x(), 0.48 - 1e-6);
  }
}

/// A held shape of each kind collides with a solid and with its mesh. Where the normal of the solid is that of a flat
/// face, the mesh has the same normal and depth.
TEST(Separation, OfAMeshIsThatOfItsSolidOnFlatFaces)
{
  for (const Shape& solid : {Shape(Box{{0.5, 0.3, 0.4}}), Shape(Cylinder{0.25, 0.4})})
    for (const Kind& kind : kinds())
    {
      Random random(kSeed);
      SCOPED_TRACE(kind.name + ", seed " + std::to_string(kSeed));
      const Shape shape = kind.make(random);
      const PlacedShape object = {solid, randomPose(random, 1.0)};
      const StateInspector of_solid = HeldShape(shape, {object}).inspector();
      const StateInspector of_mesh = HeldShape(shape, {{tessellate(solid).mesh, object.pose}}).inspector();
      CollidingPoses colliding(shape, {object}, 0.0, kSeed);
      std::size_t flat = 0;
      for (int i = 0; i < repetitions(15, 1000); ++i)
      {
        const auto pose = colliding.next();
        ASSERT_TRUE(pose.has_value());
        const std::vector<double> state = HeldShape::state(*pose);
        const auto expected = of_solid.contacts(state.data(), "", 1, 0);
        const auto found = of_mesh.contacts(state.data(), "", 1, 0);
        ASSERT_EQ(1u, expected.size());
        const Vector3d local = (object.pose.linear().transpose() * expected.front().normal).cwiseAbs();
        const bool is_flat =
            std::holds_alternative<Box>(solid) ? local.maxCoeff() > 1.0 - 1e-9 : local.z() > 1.0 - 1e-9;
        if (!is_flat || !kind.is_convex)
          continue;
        ++flat;
        ASSERT_EQ(1u, found.size());
        EXPECT_LE(degreesBetween(expected.front().normal, found.front().normal), 1.0);
        EXPECT_NEAR(expected.front().depth, found.front().depth, 1e-6);
      }
      if (kind.is_convex)
        EXPECT_GT(flat, 0u);
    }
}

/// A ball between two plates is lifted out of them. It leaves their upper edges at a flat angle, so a depth that is a
/// little longer than needed takes it away from them by a smaller part of this length.
TEST(Separation, LeavesAGapAlsoWhereTheBodiesPartAtAFlatAngle)
{
  auto plates = std::make_shared<Mesh>();
  for (const double x : {-0.05, 0.05})
  {
    const auto first = static_cast<std::uint32_t>(plates->vertices.size());
    for (const auto& [y, z] : {std::array<double, 2>{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.0}, {-0.5, 0.0}})
      plates->vertices.emplace_back(x, y, z);
    plates->triangles.push_back({first, first + 1, first + 2});
    plates->triangles.push_back({first, first + 2, first + 3});
  }
  for (const double radius : {0.0501, 0.0505, 0.052, 0.06})
  {
    SCOPED_TRACE(radius);
    const Shape ball = Sphere{radius};
    const Isometry3d pose = at(0.0, 0.0, -0.01);
    const auto contacts = HeldShape(ball, {{plates, Isometry3d::Identity()}}).contacts(pose.translation());
    ASSERT_FALSE(contacts.empty());
    EXPECT_NEAR(contacts.front().depth, 0.01 + std::sqrt(radius * radius - 0.0025), 1e-6) << "upwards";
    Isometry3d moved = pose;
    moved.pretranslate(contacts.front().depth * contacts.front().normal);
    EXPECT_EQ(oracle::Verdict::Free, oracle::verdict(oracle::PreparedShape(plates), motionOf(Isometry3d::Identity()),
                                                     oracle::PreparedShape(ball), motionOf(moved), 0.0));
  }
}

TEST(Separation, OfABodyOfSeveralShapesFreesAllOfThem)
{
  // A floor of cubes, as an octomap has it.
  std::vector<PlacedShape> cubes;
  for (int i = -20; i < 20; ++i)
    for (int j = -20; j < 20; ++j)
      cubes.push_back({Box{{0.02, 0.02, 0.02}}, at(0.02 * i + 0.01, 0.02 * j + 0.01, -0.01)});
  // Two rods that cross the floor's box from below.
  cubes.push_back({Box{{0.05, 0.05, 0.4}}, at(0.3, 0.0, -0.2)});
  cubes.push_back({Box{{0.05, 0.05, 0.4}}, at(-0.3, 0.0, -0.2)});
  const HeldShape held(cubes,
                       {{Box{{0.1, 0.1, 0.1}}, at(0.013, 0.007, 0.045)}, {Cylinder{0.02, 0.9}, at(0, 0, -0.21)}});
  const StateInspector inspector = held.inspector();
  const auto contacts = inspector.contacts(HeldShape::state(Vector3d(0, 0, 0)).data(), "", 100, 1);
  ASSERT_EQ(2u, contacts.size());
  for (const Contact& contact : contacts)
  {
    const Vector3d place = contact.depth * contact.normal;
    for (const Contact& other : inspector.contacts(HeldShape::state(place).data(), "", 100, 1))
      EXPECT_NE(contact.bodies, other.bodies) << "depth " << contact.depth << " along " << contact.normal.transpose();
  }
  const Contact& of_box = contacts[contacts[0].bodies[0] == HeldShape::kObject ? 0 : 1];
  EXPECT_NEAR(of_box.depth, 0.005, 1e-7);
  EXPECT_LT((of_box.normal + Vector3d::UnitZ()).norm(), 1e-6) << "the held floor goes down";
}
}  // namespace
}  // namespace gpu_planning_scene::core
