// A change of the scene for one request alone. No ROS master is needed.

#include <iostream>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "node/checks/check_services.h"
#include "node/messages/to_messages.h"
#include "node/scene/scene_services.h"
#include "scene/slider_robot.h"
#include "support/repetitions.h"

namespace gpu_planning_scene::core
{
namespace
{
CollisionObject boxObject(const std::string& id, const Eigen::Vector3d& position, double size)
{
  CollisionObject object;
  object.id = id;
  object.pose.position.x = position.x();
  object.pose.position.y = position.y();
  object.pose.position.z = position.z();
  object.pose.orientation.w = 1.0;
  object.primitives.resize(1);
  object.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
  object.primitives[0].dimensions = {size, size, size};
  return object;
}

PlanningSceneMessage diffScene()
{
  PlanningSceneMessage scene;
  scene.is_diff = 1;
  scene.robot_state.is_diff = 1;
  return scene;
}

/// Attaches a load to the cart.
PlanningSceneMessage diffThatAttaches()
{
  PlanningSceneMessage diff = diffScene();
  diff.robot_state.attached_collision_objects.resize(1);
  AttachedCollisionObject& attached = diff.robot_state.attached_collision_objects[0];
  attached.link_name = "cart";
  attached.touch_links = {"pole"};
  attached.object = boxObject("load", {0.3, 0.0, 0.0}, 0.3);
  attached.object.header.frame_id = "cart";
  return diff;
}

/// A scene with its services, as a node has them.
struct Node
{
  SceneStore::Lookup lookup = [](const StampedFrame& frame) -> Eigen::Isometry3d
  {
    if (frame.name != "camera")
      throw Error("frame '" + frame.name + "' is not known");
    return Eigen::Isometry3d(Eigen::Translation3d(1.0, 0.0, 0.0));
  };
  SceneStore store{sliderAndWall(5), {}, {}};
  CheckServer server{store,
                     [](std::shared_ptr<const PlanningScene> scene)
                     { return std::make_shared<CpuChecker>(std::move(scene)); },
                     {}};
  MemoryGuard memory{0};
  CheckServices checks{store, server, memory, {100000, 1000000, 1000}, {lookup}};
  SceneServices scenes{store, lookup, memory};
};

class SceneDiff : public testing::Test
{
 public:
  SceneDiff()
  {
    for (Node* node : {&asked, &changed})
      node->store.updateState({{"slide", 0.0}, {"turn", 0.0}});
    states.joint_names = {"slide", "turn"};
    for (int i = -20; i <= 20; ++i)
      for (double turn : {0.0, 0.4, 1.5})
        states.positions.insert(states.positions.end(), {0.1 * i, turn});
  }

  /// Expects that a request with the difference has the answer of a node in which the difference was applied, and that
  /// it changes nothing. Returns the verdicts.
  std::vector<std::uint8_t> compare(const PlanningSceneMessage& diff)
  {
    const Snapshot before = asked.store.snapshot();
    ApplyPlanningScene::Request apply;
    apply.scene = diff;
    const auto applied = changed.scenes.apply(apply);
    EXPECT_TRUE(applied.success) << applied.message;

    CheckStates::Request plain = states;
    plain.clearance = true;
    plain.max_contacts = 3;
    CheckStates::Request with_diff = plain;
    with_diff.scene_diff = diff;
    const auto found = asked.checks.checkStates(with_diff);
    EXPECT_TRUE(found.success) << found.message;
    const auto expected = changed.checks.checkStates(plain);
    EXPECT_EQ(expected.valid, found.valid);
    EXPECT_EQ(expected.clearance_world, found.clearance_world);
    EXPECT_EQ(expected.clearance_self, found.clearance_self);
    EXPECT_EQ(expected.contacts.size(), found.contacts.size());
    EXPECT_EQ(applied.message, found.message);
    EXPECT_EQ(before.scene->revision, found.scene_revision);

    CheckStates::Request current;
    CheckStates::Request current_with_diff;
    current_with_diff.scene_diff = diff;
    EXPECT_EQ(changed.checks.checkStates(current).valid, asked.checks.checkStates(current_with_diff).valid);

    CheckMotions::Request motions;
    motions.joint_names = {"slide"};
    motions.starts = {0.0, 0.5};
    motions.ends = {0.5, -1.5};
    motions.resolution = motions.translation_resolution = 0.05;
    CheckMotions::Request motions_with_diff = motions;
    motions_with_diff.scene_diff = diff;
    const auto moved = asked.checks.checkMotions(motions_with_diff);
    EXPECT_TRUE(moved.success) << moved.message;
    const auto expected_motions = changed.checks.checkMotions(motions);
    EXPECT_EQ(expected_motions.valid, moved.valid);
    EXPECT_EQ(expected_motions.first_invalid_fraction, moved.first_invalid_fraction);
    EXPECT_EQ(before.scene->revision, moved.scene_revision);

    CheckTrajectory::Request trajectory;
    trajectory.joint_trajectory.joint_names = {"slide"};
    trajectory.joint_trajectory.points.resize(2);
    trajectory.joint_trajectory.points[0].positions = {0.5};
    trajectory.joint_trajectory.points[1].positions = {-1.5};
    trajectory.resolution = trajectory.translation_resolution = 0.05;
    CheckTrajectory::Request trajectory_with_diff = trajectory;
    trajectory_with_diff.scene_diff = diff;
    const auto followed = asked.checks.checkTrajectory(trajectory_with_diff);
    EXPECT_TRUE(followed.success) << followed.message;
    const auto expected_parts = changed.checks.checkTrajectory(trajectory);
    EXPECT_EQ(expected_parts.start_valid, followed.start_valid);
    EXPECT_EQ(expected_parts.waypoint_valid, followed.waypoint_valid);
    EXPECT_EQ(expected_parts.part_valid, followed.part_valid);

    EXPECT_EQ(before.scene, asked.store.snapshot().scene) << "the request changed the scene";
    EXPECT_EQ(before.state, asked.store.snapshot().state);
    EXPECT_EQ(asked.checks.checkStates(states).valid, unchanged) << "a later request sees the change";
    return found.valid;
  }

  Node asked;
  Node changed;
  CheckStates::Request states;
  const std::vector<std::uint8_t> unchanged = [this]
  {
    Node fresh;
    CheckStates::Request request;
    request.joint_names = {"slide", "turn"};
    for (int i = -20; i <= 20; ++i)
      for (double turn : {0.0, 0.4, 1.5})
        request.positions.insert(request.positions.end(), {0.1 * i, turn});
    return fresh.checks.checkStates(request).valid;
  }();
};

TEST_F(SceneDiff, OfObjectsHasTheAnswerOfAnAppliedChange)
{
  PlanningSceneMessage diff = diffScene();
  diff.world.collision_objects = {boxObject("crate", {-1.0, 0.0, 0.0}, 0.3)};
  EXPECT_NE(unchanged, compare(diff));
}

TEST_F(SceneDiff, ThatRemovesAnObjectHasTheAnswerOfAnAppliedChange)
{
  PlanningSceneMessage diff = diffScene();
  diff.world.collision_objects.resize(1);
  diff.world.collision_objects[0].id = "wall";
  diff.world.collision_objects[0].operation = CollisionObject::REMOVE;
  EXPECT_NE(unchanged, compare(diff));
}

TEST_F(SceneDiff, OfAnAttachedObjectHasTheAnswerOfAnAppliedChange)
{
  EXPECT_NE(unchanged, compare(diffThatAttaches()));
}

TEST_F(SceneDiff, OfPaddingHasTheAnswerOfAnAppliedChange)
{
  PlanningSceneMessage diff = diffScene();
  diff.link_padding.resize(1);
  diff.link_padding[0].link_name = "cart";
  diff.link_padding[0].padding = 0.25;
  EXPECT_NE(unchanged, compare(diff));
}

TEST_F(SceneDiff, OfTheRobotsStateAndOfAFrameOfTfHasTheAnswerOfAnAppliedChange)
{
  PlanningSceneMessage diff = diffScene();
  diff.robot_state.joint_state.name = {"slide"};
  diff.robot_state.joint_state.position = {1.0};
  diff.world.collision_objects = {boxObject("crate", {-2.0, 0.0, 0.0}, 0.3)};
  diff.world.collision_objects[0].header.frame_id = "camera";
  EXPECT_NE(unchanged, compare(diff));
}

TEST_F(SceneDiff, OfTheMatrixHasTheAnswerOfAnAppliedChange)
{
  PlanningSceneMessage diff = diffScene();
  diff.allowed_collision_matrix.entry_names = {"cart", "wall"};
  diff.allowed_collision_matrix.entry_values.resize(2);
  diff.allowed_collision_matrix.entry_values[0].enabled = {0, 1};
  diff.allowed_collision_matrix.entry_values[1].enabled = {1, 0};
  EXPECT_NE(unchanged, compare(diff));
  CheckStates::Request twice = states;
  twice.scene_diff = diff;
  twice.allowed_collision_matrix = diff.allowed_collision_matrix;
  EXPECT_EQ("allowed_collision_matrix is given in the request and in scene_diff; give one of the two",
            asked.checks.checkStates(twice).message);
}

TEST_F(SceneDiff, OfRandomBoxesHasTheAnswerOfAnAppliedChange)
{
  const auto seed = std::random_device()();
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (int i = 0; i < repetitions(20, 300); ++i)
  {
    PlanningSceneMessage diff = diffScene();
    // The node `changed` keeps its objects, so each difference replaces the box of the same name.
    diff.world.collision_objects = {boxObject("crate", {place(generator), place(generator), 0.5}, 0.4)};
    compare(diff);
  }
}

TEST_F(SceneDiff, ThatCannotBeAppliedIsRefusedAndChangesNothing)
{
  const auto expect_refusal = [this](const PlanningSceneMessage& diff, const std::string& reason)
  {
    const std::shared_ptr<const PlanningScene> before = asked.store.snapshot().scene;
    CheckStates::Request request = states;
    request.scene_diff = diff;
    const auto response = asked.checks.checkStates(request);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(AnswerStatus::INVALID_REQUEST, response.status);
    EXPECT_EQ(reason, response.message);
    EXPECT_TRUE(response.valid.empty());
    EXPECT_EQ(before, asked.store.snapshot().scene);
  };
  PlanningSceneMessage diff = diffScene();
  diff.world.collision_objects = {boxObject("crate", {0.0, 0.0, 0.0}, 0.3)};
  diff.is_diff = 0;
  expect_refusal(diff,
                 "scene_diff: is_diff is false; set it to true, because a request can only change the scene and not "
                 "replace it");
  diff.is_diff = 1;
  diff.world.collision_objects[0].header.frame_id = "kitchen";
  expect_refusal(diff, "frame 'kitchen' is not known");
  diff.world.collision_objects[0].header.frame_id = "";
  diff.world.collision_objects[0].primitives[0].dimensions = {std::numeric_limits<double>::quiet_NaN(), 1.0, 1.0};
  CheckStates::Request request = states;
  request.scene_diff = diff;
  EXPECT_EQ(0u, asked.checks.checkStates(request).message.find("object 'crate'"));
}

TEST_F(SceneDiff, AStartStateBringsItsAttachedObjectsOrKeepsThoseOfTheScene)
{
  const PlanningSceneMessage attach = diffThatAttaches();
  CheckTrajectory::Request request;
  request.joint_trajectory.joint_names = {"slide"};
  request.joint_trajectory.points.resize(1);
  request.joint_trajectory.points[0].positions = {0.7};
  request.resolution = request.translation_resolution = 0.05;
  request.start_state.joint_state.name = {"slide", "turn"};
  request.start_state.joint_state.position = {0.0, 0.0};
  EXPECT_TRUE(asked.checks.checkTrajectory(request).valid);
  CheckTrajectory::Request with_load = request;
  with_load.start_state.attached_collision_objects = attach.robot_state.attached_collision_objects;
  const auto response = asked.checks.checkTrajectory(with_load);
  EXPECT_FALSE(response.valid);
  EXPECT_EQ("load",
            response.waypoint_body_1.at(0) == "wall" ? response.waypoint_body_2.at(0) : response.waypoint_body_1.at(0));
  EXPECT_TRUE(asked.store.snapshot().scene->attached.empty());

  ApplyPlanningScene::Request apply;
  apply.scene = attach;
  ASSERT_TRUE(asked.scenes.apply(apply).success);
  const auto kept = asked.checks.checkTrajectory(request);
  EXPECT_FALSE(kept.valid) << "start_state.is_diff is false, but it names no attached objects";
  EXPECT_EQ("", kept.message);
}
}  // namespace
}  // namespace gpu_planning_scene::core
