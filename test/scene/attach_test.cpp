// Objects that are attached to links and detached again: their poses, and the input errors.

#include <limits>

#include <gtest/gtest.h>

#include "gpu_planning_scene/planning_scene.h"
#include "model/model_testing.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
const std::vector<double> kPicked = {0.5, M_PI_2};  // slide, turn
const std::vector<double> kPlaced = {-1.0, M_PI};

Eigen::Isometry3d turnedPose(double x, double y, double z, double angle_about_z)
{
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(angle_about_z, Eigen::Vector3d::UnitZ());
}

PlanningScene sceneWithBoxes()
{
  PlanningScene scene(sliderRobot());
  scene.objects = {{"left", turnedPose(1, 0, 0, 0), {{Box{{0.1, 0.1, 0.1}}, turnedPose(0, 0, 7, 0)}}, 0.25},
                   {"right", turnedPose(2, 0, 0, 0), {{Sphere{0.1}}}},
                   {"floor", turnedPose(0, 0, -1, 0), {{HalfSpace{Eigen::Vector3d::UnitZ(), 0.0}}}}};
  return scene;
}

TEST(Attach, KeepsTheObjectWhereItIsInTheState)
{
  PlanningScene scene = sceneWithBoxes();
  scene.attach("left", "pole", {"cart"}, kPicked.data());
  ASSERT_EQ(2u, scene.objects.size());
  ASSERT_EQ(1u, scene.attached.size());
  const AttachedObject& carried = scene.attached[0];
  EXPECT_EQ("left", carried.object.id);
  EXPECT_EQ(scene.robot->linkIndex("pole"), carried.link);
  EXPECT_EQ(std::vector<int>{scene.robot->linkIndex("cart")}, carried.touch_links);
  // The pole is at x = 0.5, rotated by 90 degrees, so the object is at -0.5 m along the pole's y.
  EXPECT_TRUE(carried.object.pose.isApprox(turnedPose(0, -0.5, 0, -M_PI_2), 1e-15)) << carried.object.pose.matrix();
  EXPECT_EQ(7.0, carried.object.shapes.at(0).pose.translation().z());
  EXPECT_EQ(0.25, carried.object.padding);
  EXPECT_EQ("right", scene.bodyName(static_cast<int>(scene.robot->links().size())));
  EXPECT_EQ("left", scene.bodyName(static_cast<int>(scene.robot->links().size()) + 2));
}

TEST(Attach, StoresATouchLinkThatIsNamedTwiceOnce)
{
  PlanningScene scene = sceneWithBoxes();
  scene.attach("left", "pole", {"cart", "cart"}, kPicked.data());
  EXPECT_EQ(std::vector<int>{scene.robot->linkIndex("cart")}, scene.attached.at(0).touch_links);
}

TEST(Attach, CarriesTheObjectToWhereItIsDetached)
{
  PlanningScene scene = sceneWithBoxes();
  scene.attach("left", "pole", {}, kPicked.data());
  scene.detach("left", kPlaced.data());
  EXPECT_TRUE(scene.attached.empty());
  ASSERT_EQ(3u, scene.objects.size());
  EXPECT_EQ("left", scene.objects[2].id);
  // The pole is at x = -1, rotated by 180 degrees. The object is still at -0.5 m along the pole's y.
  EXPECT_TRUE(scene.objects[2].pose.isApprox(turnedPose(-1, 0.5, 0, M_PI_2), 1e-15)) << scene.objects[2].pose.matrix();
  EXPECT_EQ(0.25, scene.objects[2].padding);
}

TEST(Attach, OnAPlaceItNeverLeftChangesNothing)
{
  PlanningScene scene = sceneWithBoxes();
  scene.attach("left", "pole", {}, kPicked.data());
  scene.detach("left", kPicked.data());
  EXPECT_TRUE(scene.objects[2].pose.isApprox(turnedPose(1, 0, 0, 0), 1e-15));
}

TEST(Attach, LeavesTheScenesThatItWasCopiedFromAlone)
{
  const PlanningScene before = sceneWithBoxes();
  PlanningScene after = before;
  after.attach("left", "pole", {}, kPicked.data());
  EXPECT_EQ(3u, before.objects.size());
  EXPECT_TRUE(before.attached.empty());
}

TEST(Attach, RefusesWhatItDoesNotKnowAndChangesNothing)
{
  PlanningScene scene = sceneWithBoxes();
  scene.attach("right", "cart", {}, kPicked.data());
  const std::vector<double> not_finite = {std::numeric_limits<double>::quiet_NaN(), 0.0};
  const auto refused = [&](const std::string& what, const std::function<void()>& action)
  {
    const std::string message = errorOf(action);
    EXPECT_NE(std::string::npos, message.find(what)) << message;
    EXPECT_EQ(std::string::npos, message.find('\n')) << message;
    EXPECT_EQ(2u, scene.objects.size());
    EXPECT_EQ(1u, scene.attached.size());
    EXPECT_EQ("left", scene.objects[0].id);
  };
  const double* state = kPicked.data();
  refused(
      "no such object", [&] { scene.attach("drum", "pole", {}, state); });
  refused(
      "attached to link 'cart' already", [&] { scene.attach("right", "pole", {}, state); });
  refused(
      "no link 'crane'", [&] { scene.attach("left", "crane", {}, state); });
  refused(
      "no link 'crane'",
      [&] {
        scene.attach("left", "pole", {"cart", "crane"}, state);
      });
  refused(
      "half-space", [&] { scene.attach("floor", "pole", {}, state); });
  refused(
      "not finite", [&] { scene.attach("left", "pole", {}, not_finite.data()); });
  refused(
      "no such object is attached", [&] { scene.detach("left", state); });
  refused(
      "no such object is attached", [&] { scene.detach("drum", state); });
  refused("not finite", [&] { scene.detach("right", not_finite.data()); });
}
}  // namespace
}  // namespace gpu_planning_scene::core
