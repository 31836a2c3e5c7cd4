// Moving the second body by a contact's depth along its normal ends the collision, and contact points lie on both
// bodies. The oracle and brute force over directions tell what is right.

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "collision/contacts/held_shape.h"
#include "collision/geometry/primitive_solid.h"
#include "model/math_constants.h"
#include "oracle/oracle.h"
#include "support/moving_shape.h"
#include "support/repetitions.h"
#include "support/seed.h"
#include "support/triangle_soup.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

using Random = std::mt19937_64;

constexpr double kOnBody = 1e-6;  // metres

double between(Random& random, double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vector3d randomDirection(Random& random)
{
  std::normal_distribution<double> normal;
  return Vector3d(normal(random), normal(random), normal(random)).normalized();
}

/// Boxes in one mesh, each a closed component.
std::shared_ptr<const Mesh> meshOfBoxes(const std::vector<std::array<Vector3d, 2>>& boxes)
{
  auto mesh = std::make_shared<Mesh>();
  for (const auto& [size, center] : boxes)
  {
    const Mesh box = *tessellate(Box{size}).mesh;
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    for (const Vector3d& vertex : box.vertices)
      mesh->vertices.push_back(vertex + center);
    for (const auto& t : box.triangles)
      mesh->triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

/// A closed mesh whose cross section in x and y is an L.
std::shared_ptr<const Mesh> meshOfL(double size)
{
  auto mesh = std::make_shared<Mesh>();
  const std::array<std::array<double, 2>, 6> outline = {{{0, 0}, {1, 0}, {1, 0.3}, {0.3, 0.3}, {0.3, 1}, {0, 1}}};
  for (const double z : {-0.25, 0.25})
    for (const auto& [x, y] : outline)
      mesh->vertices.push_back(size * Vector3d(x - 0.5, y - 0.5, z));
  for (const auto& [i, j, k] : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}})
  {
    mesh->triangles.push_back({i, k, j});
    mesh->triangles.push_back({i + 6, j + 6, k + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i)
  {
    const std::uint32_t j = (i + 1) % 6;
    mesh->triangles.push_back({i, j, j + 6});
    mesh->triangles.push_back({i, j + 6, i + 6});
  }
  return mesh;
}

/// A mesh without its last triangles.
std::shared_ptr<const Mesh> opened(const Shape& shape, std::size_t missing)
{
  auto mesh = std::make_shared<Mesh>(*tessellate(shape).mesh);
  mesh->triangles.resize(mesh->triangles.size() - missing);
  return mesh;
}

struct Kind
{
  std::string name;
  bool is_convex;
  std::function<Shape(Random&)> make;
};

/// Kinds of shapes of 0.1 m to 0.6 m.
std::vector<Kind> kinds()
{
  const auto box = [](Random& r) { return Box{{between(r, 0.1, 0.6), between(r, 0.1, 0.6), between(r, 0.1, 0.6)}}; };
  const auto cylinder = [](Random& r) { return Cylinder{between(r, 0.05, 0.3), between(r, 0.1, 0.6)}; };
  const auto soup = [](Random& r)
  {
    return triangleSoup(
        8, [&r] { return Vector3d(between(r, -0.3, 0.3), between(r, -0.3, 0.3), between(r, -0.3, 0.3)); });
  };
  return {
      {"box", true, box},
      {"sphere", true, [](Random& r) { return Sphere{between(r, 0.05, 0.3)}; }},
      {"cylinder", true, cylinder},
      {"cone", true,
       [](Random& r) {
         return Cone{between(r, 0.05, 0.3), between(r, 0.1, 0.6)};
       }},
      {"mesh of a box", true, [=](Random& r) { return tessellate(box(r)).mesh; }},
      {"mesh of a cylinder", true, [=](Random& r) { return tessellate(cylinder(r)).mesh; }},
      {"mesh of an L", false, [](Random& r) { return meshOfL(between(r, 0.2, 0.6)); }},
      {"mesh of a table", false,
       [](Random&)
       {
         return meshOfBoxes({{Vector3d(0.6, 0.6, 0.05), Vector3d(0, 0, 0.2)},
                             {Vector3d(0.05, 0.05, 0.4), Vector3d(0.25, 0.25, 0)},
                             {Vector3d(0.05, 0.05, 0.4), Vector3d(-0.25, -0.25, 0)}});
       }},
      {"open mesh of a box", false, [=](Random& r) { return opened(box(r), 2); }},
      {"triangles", false, soup},
  };
}

/// Finds poses in which the held shape collides with the object: it approaches the centre of the object from a random
/// direction, so that it is often near the surface.
class CollidingPoses
{
 public:
  CollidingPoses(const Shape& held, const PlacedShape& object, double padding, std::uint64_t seed)
    : moving_(held, {object}, {0.0, padding}), object_(object), random_(seed)
  {
  }

  std::optional<Isometry3d> next()
  {
    for (int attempt = 0; attempt < 100; ++attempt)
    {
      Isometry3d pose = randomPose(random_, 0.0);
      const Vector3d from = randomDirection(random_);
      Vector3d goal = object_.pose.translation() + 0.1 * randomDirection(random_);
      if (const auto* plane = std::get_if<HalfSpace>(&object_.shape))
        goal -= (plane->normal.dot(goal) - plane->offset) * plane->normal + 0.3 * plane->normal;
      double free = 1.5;
      double colliding = 0.0;
      const auto collides = [&](double distance)
      {
        pose.translation() = goal + distance * from;
        return moving_.collides(pose);
      };
      if (!collides(colliding) || collides(free))
        continue;
      for (int i = 0; i < 20; ++i)
      {
        const double middle = 0.5 * (free + colliding);
        (collides(middle) ? colliding : free) = middle;
      }
      // Depths from 0.1 micrometres to the sizes of the shapes.
      const double depth = std::pow(10.0, between(random_, -7.0, -0.5));
      if (collides(std::max(0.0, colliding - depth)))
        return pose;
    }
    return std::nullopt;
  }

 private:
  MovingShape moving_;
  PlacedShape object_;
  Random random_;
};

oracle::Motion motionOf(const Isometry3d& pose)
{
  return oracle::Motion(pose);
}

/// The distance of a point from a shape, by the oracle.
double distanceTo(const oracle::PreparedShape& shape, const Isometry3d& pose, const Vector3d& point)
{
  static const oracle::PreparedShape tiny{Shape(Sphere{1e-12})};
  return oracle::distance(shape, motionOf(pose), tiny, motionOf(Isometry3d(Eigen::Translation3d(point))));
}

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
    CollidingPoses colliding(held_shape, object, padding, kSeed + scene);
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
  const Kind half_space = {"half-space", false, [](Random& r) {
                             return HalfSpace{randomDirection(r), between(r, -0.5, 0.5)};
                           }};
  for (const Kind& held : kinds())
  {
    Random random(kSeed);
    const HalfSpace plane = std::get<HalfSpace>(half_space.make(random));
    const Shape shape = held.make(random);
    const HeldShape scene(shape, {{plane, Isometry3d::Identity()}});
    const StateInspector inspector = scene.inspector();
    CollidingPoses colliding(shape, {plane, Isometry3d::Identity()}, 0.0, kSeed);
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
      CollidingPoses colliding(shape, object, 0.0, kSeed);
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
