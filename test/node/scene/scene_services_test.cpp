// Changes of the scene by services and joint states. No ROS master is needed.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "node/scene/scene_services.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
sensor_msgs::JointState jointState(const std::vector<std::string>& names, const std::vector<double>& positions)
{
  sensor_msgs::JointState message;
  message.name = names;
  message.position = positions;
  return message;
}

TEST(SceneServices, AProcessThatUsesTooMuchMemoryCanStillBeEmptied)
{
  SceneStore store(sliderAndWall(), {}, {});
  const MemoryGuard full(1);
  SceneServices scenes(store, nullptr, full);
  ApplyPlanningScene::Request asked;
  asked.scene.is_diff = true;
  asked.scene.robot_state.is_diff = true;
  asked.scene.world.collision_objects.resize(1);
  CollisionObject& object = asked.scene.world.collision_objects[0];
  object.id = "box";
  object.pose.orientation.w = 1.0;
  object.primitives.resize(1);
  object.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
  object.primitives[0].dimensions = {0.1, 0.1, 0.1};
  const ApplyPlanningScene::Response refused = scenes.apply(asked);
  EXPECT_EQ(AnswerStatus::OUT_OF_MEMORY, refused.status);
  EXPECT_NE(std::string::npos, refused.message.find("limits/memory")) << refused.message;
  object.primitives.clear();
  object.id = "wall";
  object.operation = CollisionObject::REMOVE;
  const ApplyPlanningScene::Response removed = scenes.apply(asked);
  EXPECT_TRUE(removed.success) << removed.message;
  EXPECT_TRUE(store.snapshot().scene->objects.empty());
  EXPECT_TRUE(scenes.clear().success);
}

TEST(SceneServices, AnObjectAtALinkWhoseStateIsNotKnownYetMayBeAddedLater)
{
  SceneStore store{PlanningScene(sliderRobot()), {}, {}};
  const MemoryGuard memory(0);
  SceneServices scenes(store, nullptr, memory);
  ApplyPlanningScene::Request add;
  add.scene.is_diff = add.scene.robot_state.is_diff = 1;
  CollisionObject& ball = add.scene.world.collision_objects.emplace_back();
  ball.id = "ball";
  ball.header.frame_id = "cart";
  ball.pose.orientation.w = 1.0;
  ball.primitives.resize(1);
  ball.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  ball.primitives[0].dimensions = {0.1};
  const ApplyPlanningScene::Response early = scenes.apply(add);
  EXPECT_EQ(AnswerStatus::UNAVAILABLE, early.status) << early.message;
  EXPECT_NE(std::string::npos, early.message.find("the robot's state is not known yet")) << early.message;
  scenes.take(jointState({"slide", "turn"}, {0.0, 0.0}));
  const ApplyPlanningScene::Response later = scenes.apply(add);
  EXPECT_EQ(AnswerStatus::OK, later.status) << later.message;
}

TEST(SceneServices, MentionAnUnknownBaseWhereAnObjectIsPlacedAtALink)
{
  SceneStore store(PlanningScene(sliderRobotOnFloor("planar")), {}, {});
  const MemoryGuard memory(0);
  SceneServices scenes(store, nullptr, memory);
  ApplyPlanningScene::Request add;
  add.scene.is_diff = add.scene.robot_state.is_diff = 1;
  add.scene.robot_state.joint_state.name = {"slide", "turn"};
  add.scene.robot_state.joint_state.position = {0.0, 0.0};
  CollisionObject box;
  box.id = "box";
  box.header.frame_id = "cart";
  box.pose.orientation.w = 1.0;
  box.primitives.resize(1);
  box.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  box.primitives[0].dimensions = {0.1};
  box.primitive_poses.resize(1);
  box.primitive_poses[0].orientation.w = 1.0;
  box.operation = CollisionObject::ADD;
  add.scene.world.collision_objects = {box};
  const auto at_link = scenes.apply(add);
  EXPECT_TRUE(at_link.success) << at_link.message;
  EXPECT_NE(std::string::npos, at_link.message.find("assumed at the origin of frame")) << at_link.message;
  add.scene.world.collision_objects[0].header.frame_id = store.snapshot().scene->robot->planningFrame();
  EXPECT_EQ("", scenes.apply(add).message);
}

TEST(SceneServices, NamesInAnswersAreShortAndOnOneLine)
{
  SceneStore store(sliderAndWall(), {}, {});
  const MemoryGuard memory(0);
  SceneServices scenes(store, nullptr, memory);
  ApplyPlanningScene::Request change;
  change.scene.is_diff = true;
  change.scene.robot_state.joint_state = jointState({"whe\nel"}, {0.0});
  const ApplyPlanningScene::Response warned = scenes.apply(change);
  EXPECT_TRUE(warned.success);
  EXPECT_NE(std::string::npos, warned.message.find("whe el")) << warned.message;
  std::vector<std::string> many;
  for (int i = 0; i < 100000; ++i)
    many.push_back("wheel_" + std::to_string(i));
  change.scene.robot_state.joint_state = jointState(many, std::vector<double>(many.size(), 0.0));
  EXPECT_GT(3000u, scenes.apply(change).message.size());
  change.scene.robot_state.joint_state = {};
  change.scene.world.collision_objects.resize(1);
  change.scene.world.collision_objects[0].id = "bo\nx";
  change.scene.world.collision_objects[0].operation = 9;
  const ApplyPlanningScene::Response refused = scenes.apply(change);
  EXPECT_FALSE(refused.success);
  EXPECT_EQ(AnswerStatus::INVALID_REQUEST, refused.status);
  EXPECT_NE(std::string::npos, refused.message.find("'bo x': unknown operation")) << refused.message;
}

class JointStates : public testing::Test
{
 public:
  void take(const sensor_msgs::JointState& message) { scenes.take(message); }

  SceneStore store{PlanningScene(sliderRobot()), {}, {}};
  MemoryGuard memory{0};
  SceneServices scenes{store, nullptr, memory};
};

TEST_F(JointStates, UpdateWhatTheyNameOfTheRobot)
{
  EXPECT_EQ((std::vector<bool>{false, false}), store.snapshot().known);
  take(jointState({"wheel", "turn", "flag", "bolt"}, {9.0, 0.5, 8.0, 7.0}));
  EXPECT_EQ((std::vector<bool>{false, true}), store.snapshot().known);
  EXPECT_EQ(0.5, store.snapshot().state[1]);
  take(jointState({"slide"}, {0.25}));
  EXPECT_EQ((std::vector<double>{0.25, 0.5}), store.snapshot().state);
  take(jointState({"slide", "turn"}, {}));  // as from a driver that reports only velocities
  EXPECT_EQ((std::vector<double>{0.25, 0.5}), store.snapshot().state);
}

TEST_F(JointStates, AWrongMessageChangesNothing)
{
  take(jointState({"slide", "turn"}, {0.25, 0.5}));
  EXPECT_THROW(take(jointState({"slide", "turn"}, {1.0})), Error);
  EXPECT_EQ((std::vector<double>{0.25, 0.5}), store.snapshot().state);
  take(jointState({"slide", "wheel"}, {1.0, std::nan("")}));  // the wrong value belongs to another robot
  EXPECT_EQ(1.0, store.snapshot().state[0]);
}

TEST_F(JointStates, AValueThatIsNotFiniteMakesItsJointUnknown)
{
  take(jointState({"slide", "turn"}, {0.25, 0.5}));
  EXPECT_THROW(take(jointState({"slide", "turn"}, {1.0, std::nan("")})), Error);
  EXPECT_EQ((std::vector<bool>{true, false}), store.snapshot().known);
  EXPECT_EQ(1.0, store.snapshot().state[0]);
}

/// As from a driver without the prefix of the robot.
TEST_F(JointStates, OfUnknownJointsGiveAWarningInTheLogWhileJointsHaveNoValue)
{
  testing::internal::CaptureStderr();
  take(jointState({"turn", "left_slide"}, {0.5, 0.5}));
  EXPECT_NE(std::string::npos, testing::internal::GetCapturedStderr().find(
                                   "joint_states: ignored, because the robot does not have these joints: left_slide"));
  SceneServices others{store, nullptr, memory};
  testing::internal::CaptureStderr();
  others.take(jointState({"slide", "turn", "wheel"}, {0.5, 0.5, 0.5}));
  EXPECT_EQ("", testing::internal::GetCapturedStderr()) << "another robot's";
}

TEST_F(JointStates, ThatMayBeDegreesGiveAWarningInTheLog)
{
  testing::internal::CaptureStderr();
  take(jointState({"slide", "turn"}, {2.5, 90.0}));
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(std::string::npos,
            log.find("joint_states: joint 'slide' is 2.5, outside its limits -2 to 2; values are in radians, and joint "
                     "'turn' is 90: 90 degrees are 1.5708 rad; 1 more value is outside the limits"))
      << log;
}
}  // namespace
}  // namespace gpu_planning_scene::core
