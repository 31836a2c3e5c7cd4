// The answers of check_trajectory, beside check_states, check_motions and dense samples that FCL checks. No ROS master
// is needed.

#include <cmath>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/interpolation.h"
#include "model/model_testing.h"
#include "node/checks/answering_scene.h"
#include "scene/slider_robot.h"
#include "support/fcl_agreement.h"
#include "support/repetitions.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
std::vector<std::string> variableNames(const RobotModel& robot)
{
  std::vector<std::string> names;
  for (const Variable& variable : robot.variables())
    names.push_back(variable.name);
  return names;
}

std::int32_t bodyIndex(const PlanningScene& scene, const std::string& name)
{
  for (std::int32_t body = 0;; ++body)
    if (scene.bodyName(body) == name)
      return body;
}

CheckTrajectory::Request trajectoryOf(const std::vector<std::string>& names,
                                      const std::vector<std::vector<double>>& waypoints)
{
  CheckTrajectory::Request request;
  request.resolution = request.translation_resolution = 0.05;
  request.joint_trajectory.joint_names = names;
  for (const std::vector<double>& waypoint : waypoints)
  {
    request.joint_trajectory.points.emplace_back();
    request.joint_trajectory.points.back().positions = waypoint;
  }
  return request;
}

geometry_msgs::Transform transformAt(double x, double y, double angle)
{
  geometry_msgs::Transform transform;
  transform.translation.x = x;
  transform.translation.y = y;
  transform.rotation.z = std::sin(angle / 2.0);
  transform.rotation.w = std::cos(angle / 2.0);
  return transform;
}

void addTransforms(const std::string& joint, const std::vector<geometry_msgs::Transform>& transforms,
                   CheckTrajectory::Request& request)
{
  request.multi_dof_joint_trajectory.joint_names.push_back(joint);
  request.multi_dof_joint_trajectory.points.resize(transforms.size());
  for (std::size_t i = 0; i < transforms.size(); ++i)
    request.multi_dof_joint_trajectory.points[i].transforms.push_back(transforms[i]);
}

class SliderTrajectory : public testing::Test
{
 public:
  CheckTrajectory::Response answer(const CheckTrajectory::Request& request)
  {
    return slider.services.checkTrajectory(request);
  }

  void expectRefusal(const CheckTrajectory::Request& request, const std::string& reason,
                     std::uint8_t status = AnswerStatus::INVALID_REQUEST)
  {
    const CheckTrajectory::Response response = answer(request);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(status, response.status);
    EXPECT_EQ(reason, response.message);
    EXPECT_TRUE(response.waypoint_valid.empty());
  }

  AnsweringScene slider{sliderAndWall(5)};
};

TEST_F(SliderTrajectory, EachWaypointAndEachPartIsAnswered)
{
  slider.store.updateState({{"slide", -0.5}, {"turn", 0.0}});
  // The wall is between 0.5 and 1.5; at 1.0 the cart is in it.
  const auto response = answer(trajectoryOf({"slide", "turn"}, {{0.0, 0.0}, {0.5, 0.5}, {1.0, 0.5}, {1.5, 0.5}}));
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ("", response.message);
  EXPECT_FALSE(response.valid);
  EXPECT_TRUE(response.start_valid);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1, 0, 1}), response.waypoint_valid);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1, 0, 0}), response.part_valid);
  EXPECT_EQ((std::vector<std::string>{"", "", "cart", ""}), response.waypoint_body_1);
  EXPECT_EQ((std::vector<std::string>{"", "", "wall", ""}), response.waypoint_body_2);
  EXPECT_EQ((std::vector<std::string>{"", "", "cart", "cart"}), response.part_body_1);
  EXPECT_EQ((std::vector<std::string>{"", "", "wall", "wall"}), response.part_body_2);
  EXPECT_EQ(1.0, response.last_valid_fraction.at(1));
  EXPECT_NEAR(0.6, response.first_invalid_fraction.at(2), 0.11) << "the cart hits the wall at 0.8 m";
  EXPECT_EQ(0.0, response.first_invalid_fraction.at(3)) << "this part starts in collision";
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0, 0, 0}), response.given_up);
  EXPECT_EQ("bound", response.motion_rule);
  EXPECT_EQ(5u, response.scene_revision);
  EXPECT_GT(response.states_checked, 4u);
}

TEST_F(SliderTrajectory, AnObstacleBetweenTwoFreeWaypointsIsFound)
{
  slider.store.updateState({{"slide", 0.0}, {"turn", 0.0}});
  CheckTrajectory::Request request = trajectoryOf({"slide"}, {{2.0}});
  const auto response = answer(request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_FALSE(response.valid);
  EXPECT_EQ((std::vector<std::uint8_t>{1}), response.waypoint_valid);
  EXPECT_EQ((std::vector<std::uint8_t>{0}), response.part_valid);
  request.motion_rule = "samples";
  request.resolution = request.translation_resolution = 2.0;
  const auto sampled = answer(request);
  EXPECT_TRUE(sampled.valid) << "the only samples are the two ends";
  EXPECT_EQ("samples", sampled.motion_rule);
}

TEST_F(SliderTrajectory, JointsThatItDoesNotNameKeepTheStartsValues)
{
  CheckTrajectory::Request request = trajectoryOf({"turn"}, {{0.5}, {0.0}});
  expectRefusal(
      request,
      "no value for slide, turn; give values for all joints (a named state takes no further values), or set "
      "the current state: "
      "with robot_state.joint_state in the scene file, or, for a node, with the topic joint_states or "
      "~apply_planning_scene; list joints that nobody measures, such as casters, as <passive_joint> in the SRDF",
      AnswerStatus::UNAVAILABLE);
  slider.store.updateState({{"slide", 1.0}, {"turn", 0.0}});
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), answer(request).waypoint_valid);
  request.start_state.joint_state.name = {"slide"};
  request.start_state.joint_state.position = {0.0};
  const auto response = answer(request);
  EXPECT_TRUE(response.valid) << response.message;
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1}), response.part_valid);
  EXPECT_EQ(1.0, slider.store.snapshot().state.at(0)) << "the start is that of the request alone";
}

TEST_F(SliderTrajectory, TheStartCanBeAStateOfTheSrdf)
{
  CheckTrajectory::Request request = trajectoryOf({"turn"}, {{0.5}, {0.0}});
  request.named_start = "right";
  EXPECT_FALSE(answer(request).start_valid) << "the cart is in the wall";
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0}), answer(request).waypoint_valid);
  request.named_start = "drive/left";
  const auto response = answer(request);
  EXPECT_TRUE(response.valid) << response.message;
  request.named_start = "home";
  expectRefusal(request, "the SRDF has no state 'home'; its states: drive/left, drive/right");
  request.named_start = "left";
  request.start_state.joint_state.name = {"slide"};
  request.start_state.joint_state.position = {0.0};
  expectRefusal(request, "named_start is 'left', but start_state.joint_state is not empty; give one of the two");
}

TEST_F(SliderTrajectory, AStartInCollisionIsAnAnswer)
{
  slider.store.updateState({{"slide", 1.0}, {"turn", 0.0}});
  const auto response = answer(trajectoryOf({"slide"}, {{0.0}, {-1.0}}));
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_FALSE(response.start_valid);
  EXPECT_FALSE(response.valid);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1}), response.waypoint_valid);
  EXPECT_EQ((std::vector<std::uint8_t>{0, 1}), response.part_valid);
}

TEST_F(SliderTrajectory, WrongTrajectoriesAreRefusedWithTheReason)
{
  slider.store.updateState({{"slide", 0.0}, {"turn", 0.0}});
  const auto good = trajectoryOf({"slide", "turn"}, {{0.0, 0.0}, {0.1, 0.1}});
  ASSERT_TRUE(answer(good).success);
  expectRefusal(trajectoryOf({}, {}),
                "the trajectory has no waypoints; give joint_trajectory, multi_dof_joint_trajectory, or both");
  expectRefusal(trajectoryOf({"slide"}, {}),
                "joint_trajectory has 1 joints and 0 points; give both, or leave both empty");
  expectRefusal(trajectoryOf({"slide", "turn"}, {{0.0, 0.0}, {0.0}}),
                "joint_trajectory: waypoint 1 has 1 values for 2 joints");
  expectRefusal(trajectoryOf({"slide", "turn"}, {{0.0, 0.0}, {0.0, std::nan("")}}),
                "joint_trajectory: waypoint 1: the position of 'turn' is not a finite number");
  expectRefusal(trajectoryOf({"slide", "turns"}, {{0.0, 0.0}}),
                "the robot has no variable 'turns'; the robot's variables are slide, turn");
  expectRefusal(trajectoryOf({"turn", "flag"}, {{0.0, 0.0}}),
                "joint 'flag' mimics joint 'turn', from which its value follows; leave it out; the robot's variables "
                "are slide, turn");
  expectRefusal(trajectoryOf({"turn", "turn"}, {{0.0, 0.0}}), "variable 'turn' is given twice");
  auto wrong = good;
  wrong.resolution = 0.0;
  expectRefusal(wrong,
                "resolution is 0; give the largest step between two samples: a finite number of radians above 0, for "
                "example 0.02");
  wrong = good;
  wrong.motion_rule = "spline";
  expectRefusal(wrong, "the motion rule is 'spline'; it must be samples or bound");
  wrong = good;
  wrong.translation_resolution = 1e-6;
  expectRefusal(wrong, "part 1 has more than 20000 samples; cut it into several parts, or take larger steps");
  wrong = good;
  addTransforms("slide", {transformAt(0, 0, 0), transformAt(0, 0, 0)}, wrong);
  expectRefusal(wrong,
                "multi_dof_joint_trajectory: 'slide' is neither planar nor floating; name it in joint_trajectory; the "
                "robot's planar and floating joints are: none");
  wrong.multi_dof_joint_trajectory.joint_names = {"floor"};
  expectRefusal(wrong,
                "multi_dof_joint_trajectory: 'floor' is not a joint of the robot; the robot's planar and floating "
                "joints are: none");
  wrong.multi_dof_joint_trajectory.points.pop_back();
  expectRefusal(wrong,
                "joint_trajectory has 2 points and multi_dof_joint_trajectory has 1; give the same number, or leave "
                "one of the two empty");
}

TEST_F(SliderTrajectory, ValuesBeyondTheLimitsAreNotProvenAndTheAnswerSaysSo)
{
  slider.store.updateState({{"slide", 0.0}, {"turn", 0.0}});
  const auto response = answer(trajectoryOf({"slide"}, {{0.5}, {-3.0}}));
  EXPECT_EQ((std::vector<std::uint8_t>{1, 1}), response.waypoint_valid);
  EXPECT_EQ((std::vector<std::uint8_t>{1, 0}), response.part_valid);
  EXPECT_EQ(
      "waypoint 1: joint 'slide' is -3, outside its limits -2 to 2; the motion rule \"bound\" proves no motion there",
      response.message);
}

TEST_F(SliderTrajectory, SampledValuesBeyondTheLimitsAreNamedWithTheirWaypoint)
{
  slider.store.updateState({{"slide", 0.0}, {"turn", 0.0}});
  auto request = trajectoryOf({"slide", "turn"}, {{0.5, 0.0}, {0.5, 90.0}});
  request.motion_rule = "samples";
  EXPECT_EQ(
      "waypoint 1: joint 'turn' is 90, outside its limits -3 to 3 rad; values are in radians, and 90 degrees are "
      "1.5708 rad",
      answer(request).message);
  request.joint_trajectory.points[0].positions[0] = 1e7;
  EXPECT_EQ(0u, slider.services.checkTrajectory(request).message.find("waypoint 0: the value of variable 'slide' is"));
}

TEST_F(SliderTrajectory, PartsThatNeedTooManyChecksAreMarked)
{
  AnsweringScene few(sliderAndWall(), 3);  // the last half of the motion takes two checks more
  few.store.updateState({{"slide", 0.0}, {"turn", 0.0}});
  auto request = trajectoryOf({"slide"}, {{0.7999}});  // 0.1 mm before the wall
  request.resolution = request.translation_resolution = 0.3;
  const auto response = few.services.checkTrajectory(request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ((std::vector<std::uint8_t>{1}), response.waypoint_valid);
  EXPECT_EQ((std::vector<std::uint8_t>{0}), response.part_valid);
  EXPECT_EQ((std::vector<std::uint8_t>{1}), response.given_up);
  EXPECT_EQ("", response.part_body_1.at(0));
  EXPECT_EQ(0u, response.message.find("1 of 1 parts are not proven free, because 3 checks")) << response.message;
}

TEST(MultiDofTrajectory, IsCheckedAsTheSameValuesByName)
{
  for (const std::string type : {"planar", "floating"})
  {
    SCOPED_TRACE(type);
    PlanningScene scene(sliderRobotOnFloor(type));
    scene.objects = sliderAndWall().objects;
    scene.objects[0].pose.translation().x() += 2.0;
    AnsweringScene robot(std::move(scene));
    robot.store.updateState({{"slide", 0.0}, {"turn", 0.0}});
    CheckTrajectory::Request transforms;
    transforms.resolution = transforms.translation_resolution = 0.05;
    addTransforms("floor", {transformAt(0, 0, 0), transformAt(2, 0, 0), transformAt(3, 0, 1.0)}, transforms);
    transforms.multi_dof_joint_trajectory.header.frame_id = "hall";
    const auto response = robot.services.checkTrajectory(transforms);
    ASSERT_TRUE(response.success) << response.message;
    EXPECT_NE(std::string::npos, response.message.find("assumed at the origin")) << response.message;
    EXPECT_EQ((std::vector<std::uint8_t>{1, 1, 0}), response.waypoint_valid);
    EXPECT_EQ((std::vector<std::uint8_t>{1, 1, 0}), response.part_valid);

    const std::vector<double> turned = {std::sin(0.5), std::cos(0.5)};
    const auto named =
        type == "planar"
            ? trajectoryOf({"floor/x", "floor/y", "floor/theta"}, {{0, 0, 0}, {2, 0, 0}, {3, 0, 1}})
            : trajectoryOf({"floor/trans_x", "floor/trans_y", "floor/trans_z", "floor/rot_x", "floor/rot_y",
                            "floor/rot_z", "floor/rot_w"},
                           {{0, 0, 0, 0, 0, 0, 1}, {2, 0, 0, 0, 0, 0, 1}, {3, 0, 0, 0, 0, turned[0], turned[1]}});
    const auto by_name = robot.services.checkTrajectory(named);
    EXPECT_EQ(response.waypoint_valid, by_name.waypoint_valid);
    EXPECT_EQ(response.part_valid, by_name.part_valid);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(response.first_invalid_fraction.at(i), by_name.first_invalid_fraction.at(i), 1e-9);

    CheckTrajectory::Request both = transforms;
    both.joint_trajectory = trajectoryOf({"slide"}, {{0.0}, {0.9}, {0.0}}).joint_trajectory;
    EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 0}), robot.services.checkTrajectory(both).waypoint_valid)
        << "the cart is at 2 m + 0.9 m";
    both.joint_trajectory.points.back().time_from_start = ros::Duration(2.0);
    both.multi_dof_joint_trajectory.points.back().time_from_start = ros::Duration(3.0);
    EXPECT_EQ(
        "waypoint 2 is at 2.000000 s in joint_trajectory and at 3.000000 s in multi_dof_joint_trajectory; give points "
        "of the same times",
        robot.services.checkTrajectory(both).message);

    CheckTrajectory::Request wrong = transforms;
    wrong.multi_dof_joint_trajectory.header.frame_id = "kitchen";
    EXPECT_EQ(
        "multi_dof_joint_trajectory: waypoint 0: 'floor' is given in frame 'kitchen'; it must be the planning frame "
        "'hall' or empty, because the transform is the motion of the joint from its origin",
        robot.services.checkTrajectory(wrong).message);
    wrong = transforms;
    wrong.multi_dof_joint_trajectory.points[1].transforms[0].translation.x = std::nan("");
    EXPECT_EQ("multi_dof_joint_trajectory: waypoint 1: 'floor' is not finite",
              robot.services.checkTrajectory(wrong).message);
    wrong = transforms;
    wrong.multi_dof_joint_trajectory.points[1].transforms.clear();
    EXPECT_EQ("multi_dof_joint_trajectory: waypoint 1 has 0 values for 1 joints",
              robot.services.checkTrajectory(wrong).message);
  }
}

TEST(MultiDofTrajectory, ATransformIsTheMotionFromTheOriginOfTheJoint)
{
  // The joint is 1 m in front of its parent, which is no root. The post is 5 m in front of the root: 3 m from there.
  for (const std::string type : {"planar", "floating"})
  {
    SCOPED_TRACE(type);
    PlanningScene scene(robotOf("<link name='base'/><link name='arm'/>" + boxLink("body") +
                                jointXml("lift", "prismatic", "base", "arm",
                                         "<origin xyz='1 0 0'/><axis xyz='0 0 1'/>" + std::string(kLimits)) +
                                jointXml("free", type, "arm", "body", "<origin xyz='1 0 0'/><axis xyz='0 0 1'/>")));
    WorldObject post;
    post.id = "post";
    post.pose.translation().x() = 5.0;
    post.shapes = {{Box{{0.1, 0.1, 5.0}}}};
    scene.objects = {post};
    AnsweringScene robot(std::move(scene));
    robot.store.updateState({{"lift", 0.0}});
    CheckTrajectory::Request request;
    request.resolution = request.translation_resolution = 0.05;
    addTransforms("free", {transformAt(1, 0, 0), transformAt(3, 0, 0), transformAt(5, 0, 0)}, request);
    request.start_state.multi_dof_joint_state.joint_names = {"free"};
    request.start_state.multi_dof_joint_state.transforms = {transformAt(3, 0, 0)};
    const auto response = robot.services.checkTrajectory(request);
    ASSERT_TRUE(response.success) << response.message;
    EXPECT_FALSE(response.start_valid);
    EXPECT_EQ((std::vector<std::uint8_t>{1, 0, 1}), response.waypoint_valid);
    request.multi_dof_joint_trajectory.header.frame_id = "arm";
    EXPECT_NE(std::string::npos, robot.services.checkTrajectory(request).message.find("given in frame 'arm'"));
    request.multi_dof_joint_trajectory.header.frame_id = "base";
    request.start_state.multi_dof_joint_state.header.frame_id = "arm";
    EXPECT_NE(std::string::npos, robot.services.checkTrajectory(request).message.find("given in frame 'arm'"));
  }
}

TEST(MultiDofTrajectory, APartOfARotationIsRefused)
{
  AnsweringScene robot((PlanningScene(sliderRobotOnFloor("floating"))));
  robot.store.updateState({{"slide", 0.0}, {"turn", 0.0}});
  EXPECT_FALSE(robot.services.checkTrajectory(trajectoryOf({"floor/rot_x"}, {{0.7}})).success);
}

TEST(MultiDofTrajectory, APlanarJointThatTurnsFarGivesAWarning)
{
  AnsweringScene robot((PlanningScene(sliderRobotOnFloor("planar"))));
  robot.store.updateState({{"slide", 0.0}, {"turn", 0.0}, {"floor/x", 0.0}, {"floor/y", 0.0}, {"floor/theta", 0.0}});
  const auto said = [&robot](double angle)
  { return robot.services.checkTrajectory(trajectoryOf({"floor/theta"}, {{angle}})).message; };
  EXPECT_NE(std::string::npos, said(4.0).find("joint 'floor' moves by more than half a turn before waypoint 0"));
  EXPECT_EQ(std::string::npos, said(3.0).find("half a turn"));
}

TEST(ContinuousTrajectory, TurnsInTheShorterDirectionAndSaysWhereThatMayNotBeMeant)
{
  // The arm reaches from 0.2 m to 1 m along x; the post is in the direction of -x.
  PlanningScene scene(robotOf(
      "<link name='base'/><link name='arm'><collision><origin xyz='0.6 0 0'/><geometry><box size='0.8 0.1 0.1'/>"
      "</geometry></collision></link>" +
      jointXml("turn", "continuous", "base", "arm", "<axis xyz='0 0 1'/>")));
  WorldObject post;
  post.id = "post";
  post.pose.translation().x() = -0.8;
  post.shapes = {{Box{{0.1, 0.1, 0.1}}}};
  scene.objects = {post};
  AnsweringScene robot(std::move(scene));
  robot.store.updateState({{"turn", 2.0}});
  const auto through = robot.services.checkTrajectory(trajectoryOf({"turn"}, {{4.0}}));
  EXPECT_FALSE(through.valid);
  EXPECT_EQ("", through.message);
  const auto around = robot.services.checkTrajectory(trajectoryOf({"turn"}, {{-2.0}}));
  EXPECT_FALSE(around.valid) << "from 2 to -2 rad, the shorter direction passes pi";
  robot.store.updateState({{"turn", -1.5}});
  const auto shorter = robot.services.checkTrajectory(trajectoryOf({"turn"}, {{1.7}}));
  EXPECT_FALSE(shorter.valid) << "3.2 rad are more than half a turn";
  EXPECT_EQ(
      "joint 'turn' moves by more than half a turn before waypoint 0; it is checked in the shorter "
      "direction: give more waypoints if it turns in the other one",
      shorter.message);
}

/// Random trajectories of an arm among boxes, with 20 waypoints each.
class RandomTrajectories : public testing::Test
{
 public:
  CheckTrajectory::Request randomTrajectory(std::mt19937_64& generator) const
  {
    constexpr std::size_t kWaypoints = 20;
    const std::size_t width = names.size();
    std::vector<double> waypoint = test.randomStates(1, generator());
    std::vector<std::vector<double>> waypoints = {waypoint};
    for (std::size_t i = 1; i < kWaypoints; ++i)
    {
      const std::vector<double> towards = test.randomStates(1, generator());
      for (std::size_t j = 0; j < width; ++j)
        waypoint[j] += 0.15 * (towards[j] - waypoint[j]);
      waypoints.push_back(waypoint);
    }
    return trajectoryOf(names, waypoints);
  }

  static std::vector<double> statesOf(const CheckTrajectory::Request& request)
  {
    std::vector<double> states;
    for (const auto& point : request.joint_trajectory.points)
      states.insert(states.end(), point.positions.begin(), point.positions.end());
    return states;
  }

  const TestScene& test = testScene("arm_boxes");
  AnsweringScene arm{*test.scene};
  std::vector<std::string> names = variableNames(*test.scene->robot);
};

TEST_F(RandomTrajectories, HaveTheVerdictsOfCheckStatesAndCheckMotions)
{
  const auto seed = std::random_device()();
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 generator(seed);
  std::size_t free_parts = 0;
  std::size_t parts = 0;
  for (int i = 0; i < repetitions(20, 500); ++i)
  {
    CheckTrajectory::Request request = randomTrajectory(generator);
    request.motion_rule = i % 2 == 0 ? "bound" : "samples";
    const std::vector<double> states = statesOf(request);
    request.start_state.joint_state.name = names;
    request.start_state.joint_state.position = request.joint_trajectory.points[0].positions;
    const auto found = arm.services.checkTrajectory(request);
    ASSERT_TRUE(found.success) << found.message;

    CheckStates::Request waypoints;
    waypoints.joint_names = names;
    waypoints.positions = states;
    EXPECT_EQ(arm.services.checkStates(waypoints).valid, found.waypoint_valid);
    EXPECT_EQ(found.waypoint_valid.at(0), found.start_valid);

    CheckMotions::Request motions;
    motions.joint_names = names;
    motions.starts = request.joint_trajectory.points[0].positions;
    motions.starts.insert(motions.starts.end(), states.begin(), states.end() - static_cast<long>(names.size()));
    motions.ends = states;
    motions.motion_rule = request.motion_rule;
    motions.resolution = request.resolution;
    motions.translation_resolution = request.translation_resolution;
    const auto expected = arm.services.checkMotions(motions);
    ASSERT_TRUE(expected.success) << expected.message;
    EXPECT_EQ(expected.valid, found.part_valid);
    EXPECT_EQ(expected.last_valid_fraction, found.last_valid_fraction);
    EXPECT_EQ(expected.first_invalid_fraction, found.first_invalid_fraction);
    for (std::size_t part = 0; part < found.part_valid.size(); ++part)
    {
      ++parts;
      free_parts += found.part_valid[part];
      EXPECT_EQ(found.part_valid[part] != 0,
                found.part_body_1[part].empty() && found.first_invalid_fraction[part] == 1);
    }
    const bool all_free = std::count(found.part_valid.begin(), found.part_valid.end(), 1) == 20;
    EXPECT_EQ(all_free && found.start_valid, found.valid != 0);
  }
  EXPECT_GT(free_parts, 0u);
  EXPECT_LT(free_parts, parts);
}

TEST_F(RandomTrajectories, HaveNoCollisionThatFclFindsInDenseSamplesOfAFreePart)
{
  constexpr int kSamples = 50;
  const auto seed = std::random_device()();
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 generator(seed);
  const RobotModel& robot = *test.scene->robot;
  const std::size_t width = names.size();
  std::vector<double> samples;
  BatchResult expected;
  std::size_t collisions = 0;
  for (int i = 0; i < repetitions(10, 200) || collisions < 10; ++i)
  {
    ASSERT_LT(i, 1000) << "hardly any part collides";
    CheckTrajectory::Request request = randomTrajectory(generator);
    const std::vector<double> states = statesOf(request);
    request.start_state.joint_state.name = names;
    request.start_state.joint_state.position = request.joint_trajectory.points[0].positions;
    const auto found = arm.services.checkTrajectory(request);
    ASSERT_TRUE(found.success) << found.message;
    const auto add = [&](std::size_t part, double fraction, const BodyPair& pair)
    {
      samples.resize(samples.size() + width);
      interpolate(robot, &states[(part - 1) * width], &states[part * width], fraction,
                  &samples[samples.size() - width]);
      expected.valid.push_back(pair == kNoPair ? 1 : 0);
      expected.colliding.push_back(pair);
      collisions += pair == kNoPair ? 0 : 1;
    };
    for (std::size_t part = 1; part < found.part_valid.size(); ++part)
      if (found.part_valid[part] != 0)
        for (int k = 0; k <= kSamples; ++k)
          add(part, static_cast<double>(k) / kSamples, kNoPair);
      else if (!found.part_body_1[part].empty())
        add(part, found.first_invalid_fraction[part],
            {bodyIndex(*test.scene, found.part_body_1[part]), bodyIndex(*test.scene, found.part_body_2[part])});
  }
  const FclAgreement agreement = compareWithFcl(*test.scene, samples, expected);
  EXPECT_TRUE(agreement.failures.empty()) << agreement.failures.size() << ": " << agreement.failures.front();
  EXPECT_GT(agreement.states, 1000u);
}
}  // namespace
}  // namespace gpu_planning_scene::core
