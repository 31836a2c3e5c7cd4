// Distances of hand-made pairs whose answers are known: near contact, of large bodies, of several shapes, in collision.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/state_inspector.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A link of these collision elements that moves along z.
std::shared_ptr<const RobotModel> lift(const std::string& collisions)
{
  return robotOf("<link name='base'/><link name='hand'>" + collisions + "</link>" +
                 jointXml("lift", "prismatic", "base", "hand",
                          "<axis xyz='0 0 1'/><limit lower='-10' upper='10' effort='1' velocity='1'/>"));
}

std::string element(const std::string& geometry, const std::string& origin = "<origin xyz='0 0 0'/>")
{
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}

std::shared_ptr<const PlanningScene> sceneWith(const std::string& collisions, const Shape& object, double z,
                                               double padding = 0.0)
{
  PlanningScene scene(lift(collisions));
  scene.objects.push_back({"object", Isometry3d(Eigen::Translation3d(0.0, 0.0, z)), {{object}}});
  scene.objects.back().padding = padding;
  return std::make_shared<const PlanningScene>(scene);
}

BodyDistance onlyPair(const std::shared_ptr<const PlanningScene>& scene, double height, bool is_signed = true,
                      std::vector<double>* gradient = nullptr)
{
  const DistanceQuery query{std::numeric_limits<double>::infinity(), false, true, is_signed};
  const BodyDistances found = StateInspector(scene).distances(&height, 1, "", query);
  EXPECT_EQ(found.pairs.size(), 1U);
  if (gradient)
    *gradient = found.gradients;
  return found.pairs.at(0);
}

const char* const kTilted = "<origin xyz='0.1 0.2 0' rpy='0.3 0.5 0.2'/>";

TEST(PairDistances, HaveTheRightPointsAlsoWithTinyGapsOverLargeFloors)
{
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.2, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.5, Vector3d::UnitY()) *
                                Eigen::AngleAxisd(0.3, Vector3d::UnitX()))
                                   .toRotationMatrix();
  const double reach = 0.1 * turn.row(2).cwiseAbs().sum();  // of the lowest corner below the centre of the box
  for (const double size : {1.0, 10.0, 200.0, 10000.0})
    for (const double gap : {1e-8, 1e-7, 1e-6, 1e-5, 1e-3, 0.1})
    {
      SCOPED_TRACE(std::to_string(size) + " m, gap " + std::to_string(1e9 * gap) + " nm");
      const auto scene = sceneWith(element("<box size='0.2 0.2 0.2'/>", kTilted), Box{{size, size, 1.0}}, -0.5);
      std::vector<double> gradient;
      const BodyDistance found = onlyPair(scene, reach + gap, true, &gradient);
      EXPECT_FALSE(found.collides);
      EXPECT_LE(found.distance, gap + 1e-9);
      EXPECT_GE(found.distance, gap - 1.1e-6);
      EXPECT_NEAR(found.normal.z(), -1.0, 1e-3);
      EXPECT_NEAR(gradient.at(0), 1.0, 1e-3);
      EXPECT_NEAR(found.points[0].z(), gap, 2e-6);
      EXPECT_NEAR(found.points[1].z(), 0.0, 2e-6);
      EXPECT_LT((found.points[0] - found.points[1]).head<2>().norm(), 1e-4);
      EXPECT_LT((found.points[0] - Vector3d(0.1, 0.2, reach + gap)).norm(), 0.2) << "a corner of the box";
    }
}

TEST(PairDistances, FindTheShapeThatCollidesBesideOneThatNearlyTouches)
{
  // The first box is 0.5 micrometres above the floor, which is a clearance of 0. The second one is 5 cm in the floor.
  const auto scene = sceneWith(
      element("<box size='0.2 0.2 0.2'/>") + element("<box size='0.2 0.2 0.2'/>", "<origin xyz='0.5 0 -0.05'/>"),
      HalfSpace{Vector3d::UnitZ(), 0.0}, 0.0);
  for (const bool is_signed : {false, true})
  {
    const BodyDistance found = onlyPair(scene, 0.1 + 5e-7, is_signed);
    EXPECT_TRUE(found.collides);
    EXPECT_NEAR(found.distance, is_signed ? -0.05 : 0.0, 2e-6);
  }
}

TEST(PairDistances, InCollisionAreTheDepthsOfConvexBodies)
{
  struct Case
  {
    std::string hand;
    Shape object;
    double top;  // of the object, and of the hand below its centre
    double reach;
    double padding;
  };
  const std::vector<Case> cases = {
      {"<box size='0.2 0.2 0.2'/>", Box{{1.0, 1.0, 1.0}}, 0.5, 0.1, 0.0},
      {"<sphere radius='0.1'/>", Box{{1.0, 1.0, 1.0}}, 0.5, 0.1, 0.0},
      {"<sphere radius='0.1'/>", Sphere{0.5}, 0.5, 0.1, 0.0},
      {"<box size='0.2 0.2 0.2'/>", Box{{1.0, 1.0, 1.0}}, 0.5, 0.1, 0.03},
      {"<cylinder radius='0.1' length='0.2'/>", tessellate(Box{{1.0, 1.0, 1.0}}).mesh, 0.5, 0.1, 0.0}};
  for (const Case& each : cases)
    for (const double depth : {1e-6, 1e-3, 0.02})
    {
      SCOPED_TRACE(each.hand + " " + std::to_string(depth));
      const auto scene = sceneWith(element(each.hand), each.object, 0.0, each.padding);
      std::vector<double> gradient;
      const BodyDistance found = onlyPair(scene, each.top + each.reach + each.padding - depth, true, &gradient);
      EXPECT_TRUE(found.collides);
      EXPECT_NEAR(found.distance, -depth, 1e-7);
      EXPECT_NEAR(found.depth_at_least, depth, 1e-7);
      EXPECT_LE(found.depth_at_least, depth);
      EXPECT_NEAR(gradient.at(0), 1.0, 1e-6) << "lifting the hand makes the depth less";
      EXPECT_NEAR(found.normal.z(), -1.0, 1e-6);
    }
}

TEST(PairDistances, NeverPromiseADepthThatATranslationAvoids)
{
  // A sphere in a cylinder, beside its axis: the shortest way out is sideways.
  for (const double length : {0.4, 0.7, 4.0})
    for (const double offset : {0.0, 1e-5, 7e-5, 3e-4, 1e-3})
      for (const double angle : {0.0, 0.4, 1.0, 2.5})
      {
        SCOPED_TRACE(std::to_string(length) + " " + std::to_string(offset) + " " + std::to_string(angle));
        const std::string origin = "<origin xyz='" + std::to_string(offset * std::cos(angle)) + " " +
                                   std::to_string(offset * std::sin(angle)) + " 0'/>";
        const auto scene = sceneWith(element("<sphere radius='0.02'/>", origin), Cylinder{0.1, length}, 0.0);
        const BodyDistance found = onlyPair(scene, 0.0);
        EXPECT_LE(found.depth_at_least, 0.12 - offset + 1e-6);
        EXPECT_GE(found.depth_at_least, 0.119 - offset) << "not much less";
        EXPECT_GE(-found.distance, found.depth_at_least);
      }
}
}  // namespace
}  // namespace gpu_planning_scene::core
