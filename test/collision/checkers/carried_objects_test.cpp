// Objects that a real robot's gripper carries: a box moves with the gripper, may touch the fingers, and hits other
// bodies.

#include <gtest/gtest.h>

#include "model/real_robots.h"
#include "support/carrying_scene.h"
#include "support/checkers.h"

namespace gpu_planning_scene::core
{
namespace
{
class CarriedObjects : public testing::TestWithParam<const char*>
{
 protected:
  void SetUp() override
  {
    SKIP_WITHOUT(ur5Robotiq());
    static const auto robot = ur5Robotiq().load();
    robot_ = robot;
    picked_ = robot_->defaultState();
    picked_[robot_->variableIndex("shoulder_lift_joint")] = -1.2;
    picked_[robot_->variableIndex("elbow_joint")] = 1.0;
    turned_ = picked_;
    turned_[robot_->variableIndex("shoulder_pan_joint")] += 1.0;
  }

  PlanningScene sceneWithBox() const
  {
    PlanningScene scene(robot_);
    scene.objects.push_back(boxInGripper(*robot_, picked_.data()));
    return scene;
  }

  /// The names of a pair that collides in `state`; empty if the state is free.
  std::string collision(const PlanningScene& scene, const std::vector<double>& state,
                        const std::string& group = "") const
  {
    const BatchResult result = checkerOf(GetParam(), scene).check(state.data(), 1, group);
    if (result.valid[0])
      return "";
    const auto [a, b] = result.colliding[0];
    return scene.bodyName(std::min(a, b)) + " - " + scene.bodyName(std::max(a, b));
  }

  /// A thin table under an unrotated box of the world: the table's top touches the box's bottom.
  static WorldObject tableUnder(const WorldObject& box)
  {
    const Eigen::Vector3d half = std::get<Box>(box.shapes[0].shape).size / 2.0;
    WorldObject table;
    table.id = "table";
    table.shapes = {{Box{{0.4, 0.4, 0.02}}}};
    table.pose.translation() = box.pose.translation() - Eigen::Vector3d(0.0, 0.0, half.z() + 0.01);
    return table;
  }

  /// A small ball at `distance` from the end face of the box, which is 0.1 m from the box's centre.
  WorldObject postBeside(double distance) const
  {
    WorldObject post = boxInGripper(*robot_, picked_.data());
    post.id = "post";
    post.shapes = {{Sphere{0.01}, Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.11 + distance, 0.0))}};
    return post;
  }

  std::shared_ptr<const RobotModel> robot_;
  std::vector<double> picked_;
  std::vector<double> turned_;
};

TEST_P(CarriedObjects, MayTouchTheirTouchLinksAlone)
{
  PlanningScene held = sceneWithBox();
  EXPECT_NE("", collision(held, picked_));  // the box is an object of the world between the fingers
  PlanningScene loose = held;
  held.attach("held_box", "ee_link", gripperLinks(), picked_.data());
  EXPECT_EQ("", collision(held, picked_));
  EXPECT_EQ("", collision(held, turned_));
  loose.attach("held_box", "ee_link", {}, picked_.data());
  const std::string pair = collision(loose, picked_);
  EXPECT_EQ(0u, pair.find("robotiq_85_")) << pair;
  EXPECT_NE(std::string::npos, pair.find(" - held_box")) << pair;
}

TEST_P(CarriedObjects, MoveWithTheirLinkAndStayWhereTheyArePutDown)
{
  PlanningScene scene = sceneWithBox();
  scene.attach("held_box", "ee_link", gripperLinks(), picked_.data());
  // The post is at the end of the box after the arm has turned.
  WorldObject post = boxInGripper(*robot_, turned_.data());
  post.id = "post";
  post.shapes = {{Sphere{0.01}, Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.095, 0.02))}};
  scene.objects.push_back(post);
  EXPECT_EQ("", collision(scene, picked_));
  EXPECT_EQ("post - held_box", collision(scene, turned_));

  scene.detach("held_box", picked_.data());
  EXPECT_EQ("", collision(scene, turned_));
  EXPECT_NE("", collision(scene, picked_));
}

TEST_P(CarriedObjects, HitLinksThatAreNoTouchLinks)
{
  PlanningScene scene = sceneWithBox();
  scene.attach("held_box", "ee_link", gripperLinks(), picked_.data());
  // The box is so large that it contains the base.
  std::get<Box>(scene.attached[0].object.shapes[0].shape).size = {3.0, 3.0, 3.0};
  for (const auto& link : robot_->links())
    if (link.name != "base_link")
      scene.allowed_collisions.setEntry(link.name, "held_box", true);
  EXPECT_EQ("base_link - held_box", collision(scene, picked_));
}

TEST_P(CarriedObjects, HaveTheirLinksPaddingAndTheirOwn)
{
  PlanningScene scene = sceneWithBox();
  scene.attach("held_box", "ee_link", gripperLinks(), picked_.data());
  scene.objects.push_back(postBeside(0.02));
  scene.link_padding.assign(robot_->links().size(), 0.0);
  scene.link_padding[robot_->linkIndex("ee_link")] = 0.008;
  scene.objects[0].padding = 0.004;
  scene.attached[0].padding = 0.0079;
  EXPECT_EQ("", collision(scene, picked_));
  scene.attached[0].padding = 0.0081;
  EXPECT_EQ("post - held_box", collision(scene, picked_));
}

TEST_P(CarriedObjects, HaveTheirLinksScale)
{
  PlanningScene scene = sceneWithBox();
  scene.attach("held_box", "ee_link", gripperLinks(), picked_.data());
  scene.objects.push_back(postBeside(0.02));
  for (const auto& link : robot_->links())
    scene.allowed_collisions.setEntry(link.name, "held_box", true);
  std::vector<double> scale(robot_->links().size(), 1.0);
  scale[robot_->linkIndex("ee_link")] = 1.19;  // scales the box's half length of 0.1 m
  scene.setLinkScale(scale);
  EXPECT_EQ("", collision(scene, picked_));
  scale[robot_->linkIndex("ee_link")] = 1.21;
  scene.setLinkScale(scale);
  EXPECT_EQ("post - held_box", collision(scene, picked_));
}

TEST_P(CarriedObjects, RestOnATableOnlyWhereTheMatrixAllowsIt)
{
  PlanningScene scene = sceneWithBox();
  scene.objects[0].pose.linear().setIdentity();
  scene.objects[0].shapes = {{Box{{0.04, 0.04, 0.3}}}};
  scene.objects.push_back(tableUnder(scene.objects[0]));
  scene.attach("held_box", "ee_link", gripperLinks(), picked_.data());
  EXPECT_EQ("table - held_box", collision(scene, picked_));  // touching is a collision
  PlanningScene lower = scene;
  lower.objects[0].pose.translation().z() -= 2e-9;
  EXPECT_EQ("", collision(lower, picked_));
  scene.allowed_collisions.setEntry("table", "held_box", true);
  EXPECT_EQ("", collision(scene, picked_));
}

TEST_P(CarriedObjects, CountForGroupsThatMoveTheirLink)
{
  PlanningScene scene = sceneWithBox();
  scene.attach("held_box", "ee_link", gripperLinks(), picked_.data());
  WorldObject post = boxInGripper(*robot_, picked_.data());
  post.id = "post";
  scene.objects.push_back(post);
  for (const std::string& link : gripperLinks())
    scene.allowed_collisions.setEntry(link, "post", true);
  EXPECT_EQ("post - held_box", collision(scene, picked_, "manipulator"));
  EXPECT_EQ("", collision(scene, picked_, "gripper"));
}

INSTANTIATE_TEST_SUITE_P(Checkers, CarriedObjects, testing::Values("cpu", "breadth_first", "work_queue"),
                         [](const auto& parameter) { return std::string(parameter.param); });
}  // namespace
}  // namespace gpu_planning_scene::core
