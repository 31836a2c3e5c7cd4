// Contacts of shapes with a known overlap. Every pair that collides has a contact.

#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "collision/contacts/held_shape.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/state_inspector.h"
#include "model/model_testing.h"
#include "support/moving_shape.h"
#include "support/obstacles.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr int kObject = HeldShape::kObject;

std::shared_ptr<const Mesh> meshOf(const Shape& shape)
{
  return tessellate(shape).mesh;
}

using Held = HeldShape;

TEST(Contacts, OfSpheresIsOneBetweenTheirCentres)
{
  const Held held(Sphere{0.1}, {{Sphere{0.2}, at(1, 2, 3)}});
  const auto contacts = held.contacts({1.25, 2.0, 3.0});
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].bodies, (BodyPair{kObject, held.body()}));
  EXPECT_NEAR(contacts[0].depth, 0.05, 1e-8);
  EXPECT_LT((contacts[0].normal - Vector3d::UnitX()).norm(), 1e-9) << "from the object to what is held";
  EXPECT_NEAR(contacts[0].point.x(), 1.175, 0.026);
  EXPECT_LT((contacts[0].point - Vector3d(contacts[0].point.x(), 2.0, 3.0)).norm(), 1e-9);
  EXPECT_TRUE(held.contacts({1.31, 2.0, 3.0}).empty());
}

TEST(Contacts, OfABoxInATableLieInTheirOverlapAndAreAsManyAsRequested)
{
  const Held held(Box{{0.2, 0.2, 0.2}}, {{Box{{1.0, 1.0, 0.1}}, at(0, 0, 0)}});
  const Vector3d place(0.1, 0.2, 0.14);  // 1 cm deep
  const auto contacts = held.contacts(place);
  EXPECT_GE(contacts.size(), 4u);
  for (const Contact& contact : contacts)
  {
    EXPECT_NEAR(contact.depth, 0.01, 1e-6);
    EXPECT_LT((contact.normal - Vector3d::UnitZ()).norm(), 1e-6);
    EXPECT_LE((contact.point - place).head<2>().cwiseAbs().maxCoeff(), 0.1 + 1e-6);
    EXPECT_GE(contact.point.z(), 0.04 - 1e-6);
    EXPECT_LE(contact.point.z(), 0.05 + 1e-6);
  }
  for (const std::size_t max_contacts : {1u, 2u, 3u})
  {
    EXPECT_EQ(held.contacts(place, max_contacts).size(), max_contacts);
    EXPECT_EQ(held.contacts(place, 100, max_contacts).size(), max_contacts);
  }
  EXPECT_TRUE(held.contacts(place, 0).empty());
}

/// Shapes of different kinds, 0.2 m wide along x, as primitives and as meshes.
std::map<std::string, Shape> shapes()
{
  const Shape box = Box{{0.2, 0.2, 0.2}};
  const Shape sphere = Sphere{0.1};
  const Shape cylinder = Cylinder{0.1, 0.3};
  return {{"box", box},
          {"sphere", sphere},
          {"cylinder", cylinder},
          {"mesh of a box", meshOf(box)},
          {"mesh of a sphere", meshOf(sphere)},
          {"mesh of a cylinder", meshOf(cylinder)}};
}

TEST(Contacts, OfAllKindsOfShapesPointApartAndAreAsDeepAsTheOverlap)
{
  for (const auto& [name, held_shape] : shapes())
    for (const auto& [other_name, other] : shapes())
    {
      SCOPED_TRACE(name + " in " + other_name);
      const Held held(held_shape, {{other, at(0, 0, 0)}});
      const auto contacts = held.contacts({0.19, 0.013, 0.007});
      ASSERT_FALSE(contacts.empty());
      for (const Contact& contact : contacts)
      {
        EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-6);
        EXPECT_GE(contact.depth, 0.0);
        EXPECT_LE(contact.depth, 0.01 + 1e-6) << "the boxes overlap by that much";
        EXPECT_GE(contact.point.x(), 0.09 - 1e-5);
        EXPECT_LE(contact.point.x(), 0.1 + 1e-5);
      }
      EXPECT_GT(contacts[0].normal.x(), 0.8);
      EXPECT_GT(contacts[0].depth, 0.001) << "the bodies overlap by more than a triangle does";
    }
}

TEST(Contacts, OfContainedBodiesHaveTheExitDepth)
{
  for (const bool inner_held : {true, false})
  {
    SCOPED_TRACE(inner_held);
    const Shape small = meshOf(Box{{0.1, 0.1, 0.1}});
    const Shape large = meshOf(Box{{1.0, 1.0, 1.0}});
    const Held held(inner_held ? small : large, {{inner_held ? large : small, at(0, 0, 0)}});
    const auto contacts = held.contacts({0.3, 0.0, 0.0});
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].depth, 0.25, 2e-6);
    EXPECT_LT((contacts[0].normal - Vector3d::UnitX()).norm(), 1e-9);
    const Vector3d center(inner_held ? 0.3 : 0.0, 0.0, 0.0);
    EXPECT_LE((contacts[0].point - center).cwiseAbs().maxCoeff(), 0.05 + 1e-6) << "a point of the inner box";
  }
}

TEST(Contacts, OfTouchingBodiesHaveNoDepth)
{
  for (const auto& [name, shape] : shapes())
  {
    SCOPED_TRACE(name);
    const Held held(shape, {{Box{{0.2, 1.0, 1.0}}, at(0, 0, 0)}});
    const auto contacts = held.contacts({0.2, 0.0, 0.0});
    if (std::holds_alternative<std::shared_ptr<const Mesh>>(shape) && contacts.empty())
      continue;  // the mesh of a round shape lies inside the true shape and touches nothing
    ASSERT_FALSE(contacts.empty());
    EXPECT_GE(contacts[0].depth, 0.0);
    EXPECT_LT(contacts[0].depth, 1e-8);
    EXPECT_NEAR(contacts[0].point.x(), 0.1, 1e-6);
  }
}

TEST(Contacts, WithinThePaddingAreAtTheNearestPointsAndAsDeepAsWhatIsMissing)
{
  for (const auto& [name, held_shape] : shapes())
  {
    SCOPED_TRACE(name);
    const Held held(held_shape, {{Sphere{0.1}, at(0, 0, 0)}}, 0.05);
    const auto contacts = held.contacts({0.23, 0.0, 0.0});
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].depth, 0.02, 3e-4);
    EXPECT_LT((contacts[0].normal - Vector3d::UnitX()).norm(), 0.1);
    EXPECT_LT((contacts[0].point - Vector3d(0.115, 0.0, 0.0)).norm(), 0.02);
    EXPECT_TRUE(held.contacts({0.251, 0.0, 0.0}).empty());
  }
}

TEST(Contacts, WithAHalfSpaceIsAtTheLowestPoint)
{
  for (const auto& [name, shape] : shapes())
  {
    SCOPED_TRACE(name);
    const double low = name.find("cylinder") != std::string::npos ? 0.15 : 0.1;
    const Held held(shape, {{HalfSpace{Vector3d::UnitZ(), 0.5}, at(0, 0, 0)}});
    const auto contacts = held.contacts({3.0, 4.0, 0.5 + low - 0.01});
    ASSERT_EQ(contacts.size(), 1u);
    const double tolerance = name.find("mesh") == 0 ? 2e-4 : 1e-8;
    EXPECT_NEAR(contacts[0].depth, 0.01, tolerance);
    EXPECT_NEAR(contacts[0].point.z(), 0.49, tolerance);
    EXPECT_LT((contacts[0].normal - Vector3d::UnitZ()).norm(), 1e-9) << "from the half-space to what is held";
  }
}

/// A body comes free when it moves along a contact's normal by the depth. This also holds when one box spans the other.
TEST(Contacts, AreAsDeepAsTheTranslationThatSeparatesTheShapes)
{
  const Held held(Sphere{0.3}, {{Box{{1.0, 0.2, 0.2}}, at(0, 0, 0)}});
  for (const Vector3d& place : {Vector3d(0.1, 0.02, 0.0), Vector3d(0.45, 0.02, 0.0)})
  {
    const auto contacts = held.contacts(place, 1);
    ASSERT_EQ(contacts.size(), 1u);
    const Contact& contact = contacts[0];
    EXPECT_GE(contact.depth, 0.3) << "the bar's axis lies in the ball";
    EXPECT_TRUE(held.contacts(place + (contact.depth + 1e-6) * contact.normal).empty())
        << "depth " << contact.depth << " along " << contact.normal.transpose();
  }
}

TEST(Contacts, BeginWithTheDeepestOfEachPair)
{
  const Held held(
      Box{{0.2, 0.2, 0.2}},
      {{Box{{1.0, 1.0, 0.1}}, at(0, 0, 0)}, {Box{{0.1, 1.0, 1.0}}, at(0.24, 0, 0)}, {Sphere{0.1}, at(9, 9, 9)}});
  const Vector3d place(0.1, 0.2, 0.13);  // 2 cm deep in the first box, 1 cm in the second
  const auto contacts = held.contacts(place);
  ASSERT_GT(contacts.size(), 3u);
  EXPECT_EQ(contacts[0].bodies[0], kObject);
  EXPECT_NEAR(contacts[0].depth, 0.02, 1e-6);
  EXPECT_EQ(contacts[1].bodies[0], kObject + 1);
  EXPECT_NEAR(contacts[1].depth, 0.01, 1e-6);
  for (std::size_t i = 3; i < contacts.size(); ++i)
    EXPECT_LE(contacts[i].depth, contacts[i - 1].depth);
  EXPECT_EQ(held.contacts(place, 100, 1).size(), 2u);
}

TEST(Contacts, AreThereForEveryPairThatCollidesAndForNoOther)
{
  const TestScene& test = testScene("arm_shelf");
  PlanningScene scene = *test.scene;
  const auto objects = generateObstacles({30, Vector3d(0, 0, 0.5), 0.3, 1.2, 0.4}, 5);
  scene.objects.insert(scene.objects.end(), objects.begin(), objects.end());
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    scene.objects[i].id = "object " + std::to_string(i);
  scene.link_padding.assign(scene.robot->links().size(), 0.01);
  const auto shared = std::make_shared<const PlanningScene>(scene);
  const StateInspector inspector(shared);
  CpuChecker checker(shared);
  const std::uint64_t seed = 17;
  SCOPED_TRACE("seed " + std::to_string(seed));
  const std::size_t width = scene.robot->variables().size();
  const std::vector<double> states = test.randomStates(60, seed);
  const BatchResult result = checker.check(states.data(), states.size() / width);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < result.valid.size(); ++i)
  {
    const auto contacts = inspector.contacts(&states[i * width], "", 200, 1);
    EXPECT_EQ(contacts.empty(), result.valid[i] != 0) << i;
    std::set<BodyPair> pairs;
    for (const Contact& contact : contacts)
    {
      EXPECT_TRUE(pairs.insert(contact.bodies).second);
      EXPECT_TRUE(contact.point.allFinite());
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-6);
      EXPECT_GE(contact.depth, 0.0);
    }
    if (result.valid[i] == 0)
    {
      ++hits;
      EXPECT_EQ(pairs.count(result.colliding[i]), 1u) << i;
    }
  }
  EXPECT_GT(hits, 10u);
}

TEST(Contacts, OfWrongQuestionsAreRefused)
{
  const Held held(Sphere{0.1}, {{Sphere{0.2}, at(0, 0, 0)}});
  const StateInspector inspector = held.inspector();
  EXPECT_THROW(inspector.contacts(Held::state(Vector3d(std::nan(""), 0, 0)).data(), "", 1, 0), Error);
  EXPECT_THROW(inspector.contacts(Held::state(Vector3d(0, 0, 0)).data(), "legs", 1, 0), Error);
  EXPECT_THROW(inspector.clearance(Held::state(Vector3d(0, 0, 0)).data(), "legs"), Error);
  EXPECT_THROW(StateInspector(nullptr), Error);
}

TEST(Contacts, OfTheNextSceneNeedNothingOfThePreviousOneButItsTrees)
{
  const Held held(meshOf(Sphere{0.1}), {{meshOf(Sphere{0.2}), at(0, 0, 0)}});
  auto first = std::make_unique<StateInspector>(std::make_shared<const PlanningScene>(held.scene()));
  PlanningScene moved = held.scene();
  moved.objects[0].pose = at(1, 0, 0);
  const StateInspector second(std::make_shared<const PlanningScene>(moved), first.get());
  EXPECT_FALSE(first->contacts(Held::state(Vector3d(0.25, 0, 0)).data(), "", 1, 0).empty());
  EXPECT_TRUE(second.contacts(Held::state(Vector3d(0.25, 0, 0)).data(), "", 1, 0).empty());
  first.reset();
  EXPECT_FALSE(second.contacts(Held::state(Vector3d(1.25, 0, 0)).data(), "", 1, 0).empty());
}
}  // namespace
}  // namespace gpu_planning_scene::core
