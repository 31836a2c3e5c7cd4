// Octomaps, object types, weights and postures in messages of the scene. No ROS master is needed.

#include <gtest/gtest.h>

#include "gpu_planning_scene/octomap.h"
#include "model/model_testing.h"
#include "node/messages/from_messages.h"
#include "node/messages/octomap_messages.h"
#include "node/messages/to_messages.h"
#include "scene/change_testing.h"
#include "scene/random_octree.h"

namespace gpu_planning_scene::core
{
namespace
{
class OctomapMessages : public SceneChanges
{
 protected:
  OctomapMessages()
  {
    std::mt19937_64 generator(3);
    fillAtRandom(tree_, 6.0, 20, generator);
  }

  PlanningSceneMessage octomap(bool binary, const std::string& frame = "") const
  {
    const SerializedOctree octree = serialized(tree_, binary);
    PlanningSceneMessage message;
    message.is_diff = 1;
    message.robot_state.is_diff = 1;
    OctomapWithPose& map = message.world.octomap;
    map.header.frame_id = frame;
    map.octomap.id = octree.id;
    map.octomap.binary = binary ? 1 : 0;
    map.octomap.resolution = octree.resolution;
    map.octomap.data = octree.bytes;
    return message;
  }

  void applyMessage(const PlanningSceneMessage& message)
  {
    apply(changeFrom(message, *scene_.robot, limits_, nullptr));
  }

  PlanningSceneMessage get(std::uint32_t components = 0) const
  {
    return messageOf(scene_, components, state_, std::vector<bool>(state_.size(), true));
  }

  std::string errorOfMessage(const PlanningSceneMessage& message)
  {
    return errorOf([&] { applyMessage(message); });
  }

  octomap::OcTree tree_{0.05};
};

TEST_F(OctomapMessages, AnOctomapBecomesOneObjectAndComesBackAsAnOctomap)
{
  SceneChange own_matrix;  // a full message has the matrix
  own_matrix.is_diff = true;
  own_matrix.matrix = scene_.allowed_collisions;
  apply(own_matrix);
  const PlanningScene start = scene_;
  for (const bool binary : {true, false})
  {
    PlanningSceneMessage message = octomap(binary);
    message.world.octomap.origin.position.z = 2.0;
    message.world.octomap.origin.orientation.w = 1.0;
    applyMessage(message);
    const PlanningScene first = scene_;
    EXPECT_EQ(occupiedLeaves(serialized(tree_, true), 100000).size(), object(kOctomapId).shapes.size());
    const PlanningSceneMessage back = get();
    EXPECT_TRUE(back.world.collision_objects.empty());
    EXPECT_EQ(scene_.robot->planningFrame(), back.world.octomap.header.frame_id);
    EXPECT_EQ("OcTree", back.world.octomap.octomap.id);
    EXPECT_EQ(2.0, back.world.octomap.origin.position.z);
    scene_ = PlanningScene(sliderRobot());
    applyMessage(back);
    expectSameScene(first, scene_);
    scene_ = start;
    applyMessage(messageOf(diffOf(scene_, first), *scene_.robot));
    expectSameScene(first, scene_);
  }
}

TEST_F(OctomapMessages, AnOctomapIsPlacedInItsFrame)
{
  state_ = {0.5, 0.0};
  applyMessage(octomap(true, "cart"));
  EXPECT_NEAR(0.5, object(kOctomapId).pose.translation().x(), 1e-12) << "the cart is at x = 0.5 m";
  frames_[{"camera", 0}] = poseAt(0.0, 3.0, 0.0);
  applyMessage(octomap(true, "camera"));
  EXPECT_EQ(3.0, object(kOctomapId).pose.translation().y());
}

TEST_F(OctomapMessages, OnlyAnOctomapWithAnIdChangesADifference)
{
  applyMessage(octomap(true));
  PlanningSceneMessage none = octomap(true);
  none.world.octomap = {};
  applyMessage(none);
  EXPECT_FALSE(object(kOctomapId).shapes.empty());
  none.world.octomap.octomap.id = "cleared";
  applyMessage(none);
  EXPECT_TRUE(scene_.objects.empty());
  applyMessage(octomap(true));
  const PlanningScene with = scene_;
  scene_ = PlanningScene(sliderRobot());
  const PlanningSceneMessage clears = messageOf(diffOf(with, scene_), *scene_.robot);
  EXPECT_TRUE(clears.is_diff);
  EXPECT_EQ("cleared", clears.world.octomap.octomap.id) << "as MoveIt writes it";
  scene_ = with;
  applyMessage(clears);
  EXPECT_TRUE(scene_.objects.empty());
}

TEST_F(OctomapMessages, AnOctomapWithoutOccupiedLeavesRemovesTheObject)
{
  applyMessage(octomap(true));
  tree_.clear();
  tree_.updateNode(octomap::point3d(1.0F, 1.0F, 1.0F), false);
  applyMessage(octomap(false));
  EXPECT_TRUE(scene_.objects.empty());
}

TEST_F(OctomapMessages, TheComponentsOctomapAndObjectsAreSeparate)
{
  applyMessage(octomap(true));
  change(objectChange(Operation::Add, "box", {boxAt(0.1)}));
  using Components = PlanningSceneComponents;
  PlanningSceneMessage message = get(Components::OCTOMAP);
  EXPECT_TRUE(message.world.collision_objects.empty());
  EXPECT_FALSE(message.world.octomap.octomap.data.empty());
  for (const std::uint32_t objects : {Components::WORLD_OBJECT_GEOMETRY, Components::WORLD_OBJECT_NAMES})
  {
    message = get(objects);
    ASSERT_EQ(1U, message.world.collision_objects.size());
    EXPECT_EQ("box", message.world.collision_objects[0].id);
    EXPECT_TRUE(message.world.octomap.octomap.data.empty());
  }
}

TEST_F(OctomapMessages, WrongOctomapsAreRefused)
{
  const PlanningScene before = scene_;
  PlanningSceneMessage wrong = octomap(true);
  wrong.world.octomap.octomap.id = "";
  EXPECT_NE(errorOfMessage(wrong).find("octomap.id is empty"), std::string::npos);
  wrong = octomap(true);
  wrong.world.octomap.octomap.data.pop_back();
  EXPECT_NE(errorOfMessage(wrong).find("the data end inside"), std::string::npos);
  wrong = octomap(true);
  wrong.world.octomap.octomap.resolution = 1e6;
  EXPECT_NE(errorOfMessage(wrong), "") << "a cube far away";
  wrong = octomap(true);
  wrong.world.octomap.origin.position.x = std::nan("");
  EXPECT_NE(errorOfMessage(wrong).find("not finite"), std::string::npos);
  wrong = octomap(true);
  wrong.world.octomap = {};
  wrong.world.collision_objects.resize(1);
  wrong.world.collision_objects[0].id = kOctomapId;
  EXPECT_NE(errorOfMessage(wrong).find("is kept for the octomap"), std::string::npos);
  limits_.voxels = 5;
  EXPECT_NE(errorOfMessage(octomap(true)).find("more than 5 occupied leaves (limits/voxels)"), std::string::npos);
  expectSameScene(before, scene_);
}

TEST_F(OctomapMessages, FieldsThatChangeNoVerdictComeBack)
{
  PlanningSceneMessage message;
  message.is_diff = 1;
  message.robot_state.is_diff = 1;
  message.robot_state.attached_collision_objects.resize(1);
  AttachedCollisionObject& tool = message.robot_state.attached_collision_objects[0];
  tool.link_name = "pole";
  tool.weight = 0.25;
  tool.object.id = "tool";
  tool.object.header.frame_id = "pole";
  tool.object.type.key = "hammer";
  tool.object.type.db = "{}";
  tool.object.pose.orientation.w = 1.0;
  tool.object.primitives.resize(1);
  tool.object.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  tool.object.primitives[0].dimensions = {0.1};
  tool.object.primitive_poses.resize(1);
  tool.object.primitive_poses[0].orientation.w = 1.0;
  tool.detach_posture.header.frame_id = "pole";
  tool.detach_posture.header.stamp = ros::Time(3, 5);
  tool.detach_posture.joint_names = {"finger"};
  tool.detach_posture.points.resize(1);
  tool.detach_posture.points[0].positions = {0.04};
  tool.detach_posture.points[0].velocities = {0.1};
  tool.detach_posture.points[0].accelerations = {0.2};
  tool.detach_posture.points[0].effort = {0.3};
  tool.detach_posture.points[0].time_from_start = ros::Duration(1, 7);
  applyMessage(message);
  const PlanningSceneMessage back = get();
  EXPECT_EQ(tool, back.robot_state.attached_collision_objects.at(0));
}
}  // namespace
}  // namespace gpu_planning_scene::core
