// ~compute_fk, ~compute_ik, ~compute_cartesian_path, and ~plan to poses and with path constraints, over ROS. The robot
// is the arm of config/demo. The kinematics of RobotModel and the node's own checks judge the answers.

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gpu_planning_scene/ComputeCartesianPath.h>
#include <gpu_planning_scene/ComputeFk.h>
#include <gpu_planning_scene/ComputeIk.h>
#include <gpu_planning_scene/PlanMotion.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "node/messages/object_from_message.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr char kGroup[] = "arm";
constexpr char kTip[] = "palm";
// The palm is level, 0.6 m in front of the base, and points down.
const std::vector<double> kStart = {0.0, 0.6, 1.5, 0.0, 1.0416, 0.0, 0.03};
constexpr double kTilt = 0.1;  // radians: of a level palm

geometry_msgs::PoseStamped stamped(const Eigen::Isometry3d& pose, const std::string& frame = "")
{
  geometry_msgs::PoseStamped message;
  message.header.frame_id = frame;
  message.pose = poseAt(pose);
  return message;
}

double angleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

/// The palm does not tilt by more than kTilt. It may turn about the vertical.
Constraints levelPalm()
{
  Constraints level;
  auto& orientation = level.orientation_constraints.emplace_back();
  orientation.link_name = kTip;
  orientation.orientation = poseAt(RunningNode::linkPose(kTip, kStart)).orientation;
  orientation.absolute_x_axis_tolerance = orientation.absolute_y_axis_tolerance = kTilt;
  orientation.absolute_z_axis_tolerance = 3.2;
  return level;
}

class Kinematics : public RunningNode
{
 public:
  void SetUp() override
  {
    RunningNode::SetUp();
    PlanningSceneMessage change = diffScene();
    change.robot_state.joint_state = stateMessage(kStart).joint_state;
    apply(change);
    ASSERT_EQ(1, check(kStart).valid.at(0));
  }

  static Eigen::Isometry3d tipPose(const std::vector<double>& state) { return linkPose(kTip, state); }
  static Eigen::Isometry3d moved(Eigen::Isometry3d pose, const Eigen::Vector3d& by)
  {
    pose.translation() += by;
    return pose;
  }

  /// The start with these values of a trajectory's or a solution's variables.
  static std::vector<double> stateOf(const std::vector<std::string>& names, const double* values)
  {
    std::vector<double> state = kStart;
    for (std::size_t i = 0; i < names.size(); ++i)
      state[static_cast<std::size_t>(robot->variableIndex(names[i]))] = values[i];
    return state;
  }

  /// States of a trajectory: `parts` for each straight motion, and the last waypoint.
  static std::vector<std::vector<double>> statesAlong(const trajectory_msgs::JointTrajectory& path, int parts)
  {
    std::vector<std::vector<double>> states;
    for (std::size_t i = 0; i + 1 < path.points.size(); ++i)
    {
      const std::vector<double> from = stateOf(path.joint_names, path.points[i].positions.data());
      const std::vector<double> to = stateOf(path.joint_names, path.points[i + 1].positions.data());
      for (int part = 0; part < parts; ++part)
      {
        states.push_back(from);
        for (std::size_t k = 0; k < from.size(); ++k)
          states.back()[k] += (to[k] - from[k]) * part / parts;
      }
    }
    states.push_back(stateOf(path.joint_names, path.points.back().positions.data()));
    return states;
  }

  static void expectFree(const std::vector<std::vector<double>>& states)
  {
    std::vector<double> rows;
    for (const std::vector<double>& state : states)
      rows.insert(rows.end(), state.begin(), state.end());
    const auto checked = call<CheckStates>("check_states", stateRequest(rows));
    ASSERT_TRUE(checked.success) << checked.message;
    EXPECT_EQ(states.size(), checked.valid.size());
    EXPECT_EQ(0, std::count(checked.valid.begin(), checked.valid.end(), 0));
  }

  /// ~check_trajectory proves the trajectory free between its waypoints.
  static void expectProven(const trajectory_msgs::JointTrajectory& path)
  {
    CheckTrajectory::Request request;
    request.group = kGroup;
    request.start_state.joint_state = stateMessage(kStart).joint_state;
    request.joint_trajectory = path;
    request.resolution = request.translation_resolution = 0.005;
    const auto checked = call<CheckTrajectory>("check_trajectory", request);
    ASSERT_TRUE(checked.success) << checked.message;
    EXPECT_TRUE(checked.valid);
  }

  /// Expects that the request is refused with a line that has this text.
  template <class Service>
  static void expectRefused(const std::string& service, const typename Service::Request& request,
                            const std::string& text, std::uint8_t status = AnswerStatus::INVALID_REQUEST)
  {
    const auto response = call<Service>(service, request);
    EXPECT_FALSE(response.success) << text;
    EXPECT_EQ(status, response.status) << response.message;
    EXPECT_NE(std::string::npos, response.message.find(text)) << "'" << response.message << "' does not say " << text;
    EXPECT_EQ(std::string::npos, response.message.find('\n')) << response.message;
  }
};

using ForwardKinematics = Kinematics;
using InverseKinematicsService = Kinematics;
using PlansToPoses = Kinematics;
using PathsUnderConstraints = Kinematics;
using StraightLinesService = Kinematics;

TEST_F(ForwardKinematics, IsThatOfTheRobotModel)
{
  apply(diffWith(boxObject("box", farAway(), 0.1)));
  AttachedCollisionObject pen;
  pen.link_name = kTip;
  pen.object = boxObject("pen", {0.0, 0.0, 0.2}, 0.01);
  pen.object.header.frame_id = kTip;
  pen.object.subframe_names = {"tip"};
  pen.object.subframe_poses = {poseAt(Eigen::Vector3d(0.0, 0.0, 0.1))};
  apply(diffWith(pen));
  ComputeFk::Request request;
  request.frames = {"base", kTip, "left_finger", "box", "pen", "pen/tip", ""};
  request.joint_names = {"waist", "elbow"};
  request.positions = {0.3, 1.4, -0.7, 0.5};
  const auto response = call<ComputeFk>("compute_fk", request);
  ASSERT_TRUE(response.success) << response.message;
  ASSERT_EQ(14U, response.poses.size());
  for (std::size_t row = 0; row < 2; ++row)
  {
    const std::vector<double> state = stateOf(request.joint_names, request.positions.data() + 2 * row);
    const Eigen::Isometry3d pen_pose = linkPose(kTip, state) * Eigen::Translation3d(0.0, 0.0, 0.2);
    const std::vector<Eigen::Isometry3d> expected = {linkPose("base", state),
                                                     linkPose(kTip, state),
                                                     linkPose("left_finger", state),
                                                     Eigen::Isometry3d(Eigen::Translation3d(farAway())),
                                                     pen_pose,
                                                     pen_pose * Eigen::Translation3d(0.0, 0.0, 0.1),
                                                     Eigen::Isometry3d::Identity()};
    for (std::size_t i = 0; i < expected.size(); ++i)
    {
      const geometry_msgs::PoseStamped& pose = response.poses[row * expected.size() + i];
      EXPECT_TRUE(isometryOf(pose.pose).isApprox(expected[i], 1e-12)) << request.frames[i];
      EXPECT_EQ(robot->planningFrame(), pose.header.frame_id);
    }
  }
}

TEST_F(ForwardKinematics, WithoutValuesIsThatOfTheCurrentState)
{
  ComputeFk::Request request;
  request.frames = {kTip};
  const auto response = call<ComputeFk>("compute_fk", request);
  ASSERT_EQ(1U, response.poses.size()) << response.message;
  EXPECT_TRUE(isometryOf(response.poses[0].pose).isApprox(tipPose(kStart), 1e-12));
}

TEST_F(ForwardKinematics, RefusesWrongRequestsInOneLine)
{
  ComputeFk::Request request;
  expectRefused<ComputeFk>("compute_fk", request, "frames is empty");
  request.frames = {"plam"};
  expectRefused<ComputeFk>("compute_fk", request, "the scene has no frame 'plam'; did you mean 'palm'");
  request.frames = {kTip};
  request.joint_names = {"knee"};
  request.positions = {0.0};
  expectRefused<ComputeFk>("compute_fk", request, "knee");
  request.joint_names = {"waist", "elbow"};
  expectRefused<ComputeFk>("compute_fk", request, "positions");
}

ComputeIk::Request ikFor(const std::vector<Eigen::Isometry3d>& poses)
{
  ComputeIk::Request request;
  request.group = kGroup;
  for (const Eigen::Isometry3d& pose : poses)
    request.poses.push_back(stamped(pose));
  return request;
}

/// Poses of the palm in random states that are free in the node's scene.
std::vector<Eigen::Isometry3d> posesOfFreeStates(std::size_t count)
{
  std::mt19937_64 generator(1);
  std::vector<Eigen::Isometry3d> poses;
  std::vector<double> state = kStart;
  while (poses.size() < count)
  {
    RunningNode::robot->randomState(generator, state.data());
    state.back() = kStart.back();  // the gripper
    if (RunningNode::check(state).valid.at(0) != 0)
      poses.push_back(RunningNode::linkPose(kTip, state));
  }
  return poses;
}

double largestDifference(const std::vector<double>& a, const std::vector<double>& b)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST_F(InverseKinematicsService, FindsFreeStatesWithThePosesOfForwardKinematics)
{
  apply(diffWith(boxObject("box", {0.5, 0.3, 0.3}, 0.3)));
  const std::vector<Eigen::Isometry3d> wanted = posesOfFreeStates(50);
  ComputeIk::Request request = ikFor(wanted);
  request.seed_names = {"wrist_roll"};
  request.seed = {1.0};
  request.max_solutions = 4;
  request.clearance = 1;
  const auto found = call<ComputeIk>("compute_ik", request);
  ASSERT_TRUE(found.success) << found.message;
  EXPECT_EQ("", found.message);
  ASSERT_EQ(wanted.size(), found.counts.size());
  EXPECT_EQ(std::vector<std::uint8_t>(wanted.size(), ComputeIk::Response::SOLVED), found.pose_status);
  EXPECT_EQ(std::vector<std::string>(wanted.size()), found.faults);
  const std::size_t width = found.joint_names.size();
  ASSERT_EQ(6U, width);
  ASSERT_EQ(found.distances.size() * width, found.solutions.size());
  EXPECT_EQ(found.distances.size(), found.clearance_world.size());
  EXPECT_GT(found.distances.size(), 3 * wanted.size() / 2);  // many poses have several solutions

  ComputeFk::Request forward;
  forward.frames = {kTip};
  forward.joint_names = found.joint_names;
  forward.positions = found.solutions;
  const auto reached = call<ComputeFk>("compute_fk", forward);
  ASSERT_EQ(found.distances.size(), reached.poses.size()) << reached.message;
  std::vector<std::vector<double>> states;
  for (std::size_t pose = 0; pose < wanted.size(); ++pose)
    for (std::uint32_t i = 0; i < found.counts[pose]; ++i)
    {
      const std::size_t at = states.size();
      const Eigen::Isometry3d palm = isometryOf(reached.poses[at].pose);
      EXPECT_LE((palm.translation() - wanted[pose].translation()).norm(), 1e-6 + 1e-12);
      EXPECT_LE(angleBetween(palm, wanted[pose]), 1e-6 + 1e-9);
      EXPECT_GT(found.clearance_world[at], 0.0);
      states.push_back(stateOf(found.joint_names, found.solutions.data() + at * width));
      if (i == 0)
        continue;
      EXPECT_GE(found.distances[at], found.distances[at - 1]);
      EXPECT_GE(largestDifference(states[at], states[at - 1]), 0.1);
    }
  expectFree(states);
}

TEST_F(InverseKinematicsService, TakesPosesInTheFramesOfLinksAndObjects)
{
  apply(diffWith(boxObject("box", {0.3, 0.4, 0.5}, 0.1)));
  const Eigen::Isometry3d in_box(Eigen::Translation3d(0.0, 0.0, 0.4));
  const Eigen::Isometry3d below(Eigen::Translation3d(0.0, 0.0, -0.1));
  ComputeIk::Request request = ikFor({});
  request.orientation_tolerance = 4.0;  // any
  request.poses = {stamped(in_box, "box"), stamped(below, kTip)};
  const auto found = call<ComputeIk>("compute_ik", request);
  ASSERT_EQ(2U, found.counts.size()) << found.message;
  ASSERT_EQ(12U, found.solutions.size()) << found.faults[0] << found.faults[1];
  const Eigen::Vector3d in_frame_of_box = tipPose(stateOf(found.joint_names, found.solutions.data())).translation();
  EXPECT_LE((in_frame_of_box - Eigen::Vector3d(0.3, 0.4, 0.9)).norm(), 1e-6 + 1e-12);
  const Eigen::Vector3d in_frame_of_palm =
      tipPose(stateOf(found.joint_names, found.solutions.data() + 6)).translation();
  EXPECT_LE((in_frame_of_palm - (tipPose(kStart) * below).translation()).norm(), 1e-6 + 1e-12);
}

TEST_F(InverseKinematicsService, SaysForEachPoseWhyItHasNoSolution)
{
  const Eigen::Isometry3d near = moved(tipPose(kStart), {0.0, 0.2, 0.0});
  apply(diffWith(boxObject("box", near.translation(), 0.05)));
  const auto found = call<ComputeIk>(
      "compute_ik", ikFor({near, moved(tipPose(kStart), {5.0, 0.0, 0.0}), moved(tipPose(kStart), {0.0, -0.2, 0.0})}));
  ASSERT_TRUE(found.success) << found.message;
  EXPECT_EQ((std::vector<std::uint8_t>{ComputeIk::Response::IN_COLLISION, ComputeIk::Response::NO_SOLUTION,
                                       ComputeIk::Response::SOLVED}),
            found.pose_status);
  EXPECT_EQ((std::vector<std::uint32_t>{0, 0, 1}), found.counts);
  ASSERT_EQ(3U, found.faults.size());
  EXPECT_NE(std::string::npos, found.faults[0].find("box")) << found.faults[0];
  EXPECT_NE(std::string::npos, found.faults[1].find("no solution in 200 attempts: the nearest state is"))
      << found.faults[1];
  EXPECT_NE(std::string::npos, found.faults[1].find("m from the wanted position")) << found.faults[1];
  EXPECT_EQ("", found.faults[2]);
  ComputeIk::Request blind = ikFor({near});
  blind.ignore_collisions = 1;
  EXPECT_EQ(std::vector<std::uint8_t>{ComputeIk::Response::SOLVED}, call<ComputeIk>("compute_ik", blind).pose_status);
  ComputeIk::Request without = ikFor({near});
  without.scene_diff = diffWith(objectOperation("box", CollisionObject::REMOVE));
  EXPECT_EQ(std::vector<std::uint8_t>{ComputeIk::Response::SOLVED}, call<ComputeIk>("compute_ik", without).pose_status);
}

TEST_F(InverseKinematicsService, RefusesWrongRequestsInOneLine)
{
  const ComputeIk::Request good = ikFor({tipPose(kStart), tipPose(kStart)});
  const auto refused = [&good](const std::string& text, const std::function<void(ComputeIk::Request&)>& spoil)
  {
    ComputeIk::Request request = good;
    spoil(request);
    expectRefused<ComputeIk>("compute_ik", request, text);
  };
  using Request = ComputeIk::Request;
  refused(
      "poses is empty", [](Request& r) { r.poses.clear(); });
  refused(
      "leg", [](Request& r) { r.group = "leg"; });
  refused(
      "the scene has no frame 'plam'; did you mean 'palm'", [](Request& r) { r.link = "plam"; });
  refused("frame 'base' does not move with the robot", [](Request& r) { r.link = "base"; });
  refused("group 'gripper' has no joint that moves link 'palm'",
          [](Request& r)
          {
            r.group = "gripper";
            r.link = kTip;
          });
  Request unknown_frame = good;
  unknown_frame.poses[1].header.frame_id = "nowhere";
  expectRefused<ComputeIk>("compute_ik", unknown_frame, "pose 1: frame 'nowhere'", AnswerStatus::UNAVAILABLE);
  refused(
      "pose 1: the quaternion of the orientation has the length 0",
      [](Request& r) { r.poses[1].pose.orientation = geometry_msgs::Quaternion(); });
  refused(
      "pose 0: the position", [](Request& r) { r.poses[0].pose.position.x = std::nan(""); });
  refused(
      "position_tolerance is -1; it must be at least 1e-9", [](Request& r) { r.position_tolerance = -1.0; });
  refused("orientation_tolerance is ", [](Request& r) { r.orientation_tolerance = 1e-12; });
  refused(
      "seed has 2 rows; give one state",
      [](Request& r)
      {
        r.seed_names = {"waist", "elbow"};
        r.seed = {0.0, 0.1, 0.2, 0.3};  // two rows
      });
  refused(
      "nose", [](Request& r) { r.named_seed = "nose"; });
  refused(
      "2 poses with up to 600000 attempts each; a request may have 1000000 (limits/ik_attempts)",
      [](Request& r) { r.max_attempts = 600000; });
  refused("2 poses with up to 60000 solutions each; a request may have 100000 (limits/ik_solutions)",
          [](Request& r) { r.max_solutions = 60000; });
  refused("limits/inspected_states",
          [](Request& r)
          {
            r.clearance = 1;
            r.max_solutions = 6000;
          });
}

PlanMotion::Request planTo(const std::vector<Eigen::Isometry3d>& poses)
{
  PlanMotion::Request request;
  request.group = kGroup;
  for (const Eigen::Isometry3d& pose : poses)
    request.goal_poses.push_back(stamped(pose));
  request.allowed_planning_time = 20.0;
  request.simplify = 1;
  return request;
}

TEST_F(PlansToPoses, EndAtThePoseAndAreFree)
{
  // Between the palm and the goal.
  apply(diffWith(boxObject("box", tipPose(kStart).translation() + Eigen::Vector3d(0.0, -0.25, 0.0), 0.2)));
  const Eigen::Isometry3d goal = moved(tipPose(kStart), {0.0, -0.5, 0.0});
  const auto plan = call<PlanMotion>("plan", planTo({goal}));
  ASSERT_TRUE(plan.success) << plan.message;
  EXPECT_EQ(AnswerStatus::OK, plan.status);
  EXPECT_EQ("", plan.message);
  ASSERT_GE(plan.trajectory.points.size(), 2U);
  const std::vector<std::vector<double>> states = statesAlong(plan.trajectory, 100);
  EXPECT_EQ(kStart, states.front());
  const Eigen::Isometry3d end = tipPose(states.back());
  EXPECT_LE((end.translation() - goal.translation()).norm(), 1e-4);
  EXPECT_LE(angleBetween(end, goal), 1e-3);
  expectFree(states);
  expectProven(plan.trajectory);
}

TEST_F(PlansToPoses, TakeOneOfSeveralGoals)
{
  PlanMotion::Request request = planTo({moved(tipPose(kStart), {5.0, 0.0, 0.0})});
  auto& up = request.goal_constraints.emplace_back();
  auto& position = up.position_constraints.emplace_back();
  position.link_name = kTip;
  position.constraint_region.primitives.resize(1);
  position.constraint_region.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
  position.constraint_region.primitives[0].dimensions = {0.1, 0.1, 0.1};
  position.constraint_region.primitive_poses = {poseAt(Eigen::Vector3d(0.3, 0.3, 0.7))};
  const auto plan = call<PlanMotion>("plan", request);
  ASSERT_TRUE(plan.success) << plan.message;
  const Eigen::Vector3d end = tipPose(statesAlong(plan.trajectory, 1).back()).translation();
  EXPECT_LE((end - Eigen::Vector3d(0.3, 0.3, 0.7)).cwiseAbs().maxCoeff(), 0.05 + 1e-9);
}

TEST_F(PlansToPoses, SayWhyTheGoalIsNotReached)
{
  const auto far = call<PlanMotion>("plan", planTo({moved(tipPose(kStart), {5.0, 0.0, 0.0})}));
  EXPECT_FALSE(far.success);
  EXPECT_EQ(PlanMotion::Response::GOAL_UNREACHABLE, far.status) << far.message;
  EXPECT_NE(std::string::npos, far.message.find("m from the wanted position")) << far.message;
  const Eigen::Isometry3d goal = moved(tipPose(kStart), {0.0, 0.3, 0.0});
  apply(diffWith(boxObject("box", goal.translation(), 0.05)));
  const auto inside = call<PlanMotion>("plan", planTo({goal}));
  EXPECT_FALSE(inside.success);
  EXPECT_EQ(PlanMotion::Response::GOAL_IN_COLLISION, inside.status) << inside.message;
  EXPECT_NE(std::string::npos, inside.message.find("box")) << inside.message;
}

TEST_F(PlansToPoses, RefuseWrongRequestsInOneLine)
{
  const PlanMotion::Request good = planTo({tipPose(kStart)});
  const auto refused = [&good](const std::string& text, const std::function<void(PlanMotion::Request&)>& spoil)
  {
    PlanMotion::Request request = good;
    spoil(request);
    expectRefused<PlanMotion>("plan", request, text);
  };
  using Request = PlanMotion::Request;
  const auto joint = [](const std::string& name, double position, double tolerance)
  {
    JointConstraint constraint;
    constraint.joint_name = name;
    constraint.position = position;
    constraint.tolerance_above = constraint.tolerance_below = tolerance;
    return constraint;
  };
  Request unknown_frame = good;
  unknown_frame.goal_poses[0].header.frame_id = "nowhere";
  expectRefused<PlanMotion>("plan", unknown_frame, "goal_poses[0]: frame 'nowhere'", AnswerStatus::UNAVAILABLE);
  refused(
      "the scene has no frame 'plam'; did you mean 'palm'", [](Request& r) { r.goal_link = "plam"; });
  refused("frame 'base' does not move with the robot", [](Request& r) { r.goal_link = "base"; });
  refused(
      "goal_link is 'palm', but goal_poses is empty",
      [](Request& r)
      {
        r.goal_link = kTip;
        r.goal_poses.clear();
        r.named_goal = "ready";
      });
  refused(
      "goal_poses[0]: the quaternion of the orientation has the length 0",
      [](Request& r) { r.goal_poses[0].pose.orientation = geometry_msgs::Quaternion(); });
  refused(
      "goal_position_tolerance is 1e-10; it must be at least 1e-9",
      [](Request& r) { r.goal_position_tolerance = 1e-10; });
  refused("goal_orientation_tolerance is -0.1; it must be", [](Request& r) { r.goal_orientation_tolerance = -0.1; });
  refused(
      "start has 2 rows; give one state",
      [](Request& r)
      {
        r.start_names = {"waist"};
        r.start = {0.0, 0.1};  // two rows
      });
  refused("goal_constraints[0] has no constraint", [](Request& r) { r.goal_constraints.resize(1); });
  refused(
      "goal_constraints[0]: two ranges of joint 'waist' contradict each other",
      [&joint](Request& r)
      {
        r.goal_constraints.resize(1);
        r.goal_constraints[0].joint_constraints = {joint("waist", 0.0, 0.1), joint("waist", 1.0, 0.1)};
      });
  refused(
      "path_constraints: two ranges of joint 'waist' contradict each other",
      [&joint](Request& r) {
        r.path_constraints.joint_constraints = {joint("waist", 0.0, 0.1), joint("waist", 1.0, 0.1)};
      });
  refused("path_constraints: the robot has no variable 'knee'",
          [&joint](Request& r) { r.path_constraints.joint_constraints = {joint("knee", 0.0, 0.1)}; });
  refused("path_constraints: the frame 'palm' moves with the group 'arm'",
          [](Request& r)
          {
            r.path_constraints = levelPalm();
            r.path_constraints.orientation_constraints[0].header.frame_id = kTip;
          });
  refused("path_constraints: orientation_constraints[0]: the quaternion of the orientation has the length 0",
          [](Request& r)
          {
            r.path_constraints = levelPalm();
            r.path_constraints.orientation_constraints[0].orientation = geometry_msgs::Quaternion();
          });
  refused("a tolerance is 0; it must be at least",
          [](Request& r)
          {
            r.path_constraints = levelPalm();
            r.path_constraints.orientation_constraints[0].absolute_x_axis_tolerance = 0.0;
          });
}

TEST_F(PathsUnderConstraints, HoldBetweenTheWaypointsToo)
{
  apply(diffWith(boxObject("box", tipPose(kStart).translation() + Eigen::Vector3d(0.0, -0.25, 0.0), 0.2)));
  const Eigen::Isometry3d goal = moved(tipPose(kStart), {0.0, -0.5, 0.0});
  PlanMotion::Request request = planTo({goal});
  request.path_constraints = levelPalm();
  const auto plan = call<PlanMotion>("plan", request);
  ASSERT_TRUE(plan.success) << plan.message;
  ASSERT_GE(plan.trajectory.points.size(), 2U);
  const std::vector<std::vector<double>> states = statesAlong(plan.trajectory, 100);
  const Eigen::Vector3d up = tipPose(kStart).linear().col(2);
  double largest = 0.0;
  for (const std::vector<double>& state : states)
    largest = std::max(largest, std::acos(std::min(1.0, tipPose(state).linear().col(2).dot(up))));
  // A tilt about two axes, each by at most kTilt.
  EXPECT_LE(largest, std::acos(std::cos(kTilt) * std::cos(kTilt)) + 1e-9);
  EXPECT_LE((tipPose(states.back()).translation() - goal.translation()).norm(), 1e-4);
  expectFree(states);
  expectProven(plan.trajectory);
}

TEST_F(PathsUnderConstraints, KeepAPointInItsRegion)
{
  // A straight motion to the nearest state of this goal leaves the height by 1 cm.
  Eigen::Isometry3d goal = tipPose(kStart);
  goal.translation().head<2>() = Eigen::Vector2d(0.35, -0.2);
  PlanMotion::Request request = planTo({goal});
  constexpr double kThickness = 0.01;  // metres
  auto& height = request.path_constraints.position_constraints.emplace_back();
  height.link_name = kTip;
  height.constraint_region.primitives.resize(1);
  height.constraint_region.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
  height.constraint_region.primitives[0].dimensions = {3.0, 3.0, kThickness};
  height.constraint_region.primitive_poses = {poseAt(Eigen::Vector3d(tipPose(kStart).translation()))};
  const auto plan = call<PlanMotion>("plan", request);
  ASSERT_TRUE(plan.success) << plan.message;
  for (const std::vector<double>& state : statesAlong(plan.trajectory, 100))
    ASSERT_LE(std::abs(tipPose(state).translation().z() - tipPose(kStart).translation().z()), 0.5 * kThickness);
}

TEST_F(PathsUnderConstraints, SayWhichEndViolatesThem)
{
  PlanMotion::Request request;
  request.group = kGroup;
  request.goal_names = {"wrist_pitch"};
  request.goals = {0.5};
  request.path_constraints = levelPalm();
  const auto tilted = call<PlanMotion>("plan", request);
  EXPECT_FALSE(tilted.success);
  EXPECT_EQ(PlanMotion::Response::GOAL_VIOLATES_CONSTRAINTS, tilted.status) << tilted.message;
  EXPECT_NE(std::string::npos, tilted.message.find("the goal is outside the path constraints: ")) << tilted.message;
  request.start_names = request.goal_names;
  request.start = request.goals;
  const auto from_tilted = call<PlanMotion>("plan", request);
  EXPECT_FALSE(from_tilted.success);
  EXPECT_EQ(PlanMotion::Response::START_VIOLATES_CONSTRAINTS, from_tilted.status) << from_tilted.message;
  EXPECT_NE(std::string::npos, from_tilted.message.find("the start is outside the path constraints: "))
      << from_tilted.message;
}

ComputeCartesianPath::Request linesThrough(const std::vector<Eigen::Isometry3d>& poses)
{
  ComputeCartesianPath::Request request;
  request.group = kGroup;
  for (const Eigen::Isometry3d& pose : poses)
    request.waypoints.push_back(stamped(pose));
  return request;
}

TEST_F(PathsUnderConstraints, AreRefusedInAFrameOfTfThatHangsOnALinkOfTheGroup)
{
  tf2_ros::StaticTransformBroadcaster broadcaster;
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const auto& [parent, child] : {std::pair<std::string, std::string>(robot->planningFrame(), kTip),
                                      {kTip, "bracket"},
                                      {"bracket", "lens"},
                                      {robot->planningFrame(), "wall_board"}})
  {
    geometry_msgs::TransformStamped& transform = transforms.emplace_back();
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    transform.transform.rotation.w = 1.0;
  }
  broadcaster.sendTransform(transforms);
  PlanMotion::Request plan = planTo({tipPose(kStart)});
  ComputeCartesianPath::Request lines = linesThrough({tipPose(kStart)});
  for (const std::string frame : {"lens", "wall_board"})
  {
    plan.path_constraints = levelPalm();
    plan.path_constraints.orientation_constraints[0].header.frame_id = frame;
    lines.path_constraints = plan.path_constraints;
    if (frame == "lens")
    {
      const std::string fault =
          "path_constraints: the frame 'lens' moves with the group 'arm', because it hangs on the link 'palm'";
      expectRefused<PlanMotion>("plan", plan, fault);
      expectRefused<ComputeCartesianPath>("compute_cartesian_path", lines, fault);
      continue;
    }
    EXPECT_EQ(AnswerStatus::OK, call<PlanMotion>("plan", plan).status);
    const auto followed = call<ComputeCartesianPath>("compute_cartesian_path", lines);
    EXPECT_EQ(1.0, followed.fraction) << followed.message;
  }
}

TEST_F(StraightLinesService, FollowTheLinesAndAreFree)
{
  const Eigen::Isometry3d corner = moved(tipPose(kStart), {0.0, 0.0, 0.15});
  const Eigen::Isometry3d end = moved(corner, {0.0, 0.2, 0.0});
  const Eigen::Vector3d begin = tipPose(kStart).translation();
  // Between states that are 0.15 m apart, the palm would leave the line by millimetres.
  for (const double step : {0.0, 0.01, 0.15})
  {
    SCOPED_TRACE(step);
    ComputeCartesianPath::Request request = linesThrough({corner, end});
    request.max_step = step;
    const auto path = call<ComputeCartesianPath>("compute_cartesian_path", request);
    ASSERT_TRUE(path.success) << path.message;
    EXPECT_EQ("", path.message);
    EXPECT_EQ(1.0, path.fraction);
    if (step < 0.1)
      EXPECT_GE(path.trajectory.points.size(), 36U);  // 0.35 m in steps of 0.01 m
    const std::vector<std::vector<double>> states = statesAlong(path.trajectory, 20);
    for (const std::vector<double>& state : states)
    {
      const Eigen::Isometry3d palm = tipPose(state);
      const Eigen::Vector3d from_begin = palm.translation() - begin;
      const double first_line = from_begin.head<2>().norm();
      const double second_line = std::hypot(from_begin.x(), from_begin.z() - 0.15);
      EXPECT_LE(std::min(first_line, second_line), 1e-4);
      EXPECT_LE(angleBetween(palm, end), 1e-3);
    }
    EXPECT_LE((tipPose(states.back()).translation() - end.translation()).norm(), 1e-4);
    expectFree(states);
    expectProven(path.trajectory);
  }
}

TEST_F(StraightLinesService, EndBeforeAnObjectAndSayWhy)
{
  const Eigen::Isometry3d end = moved(tipPose(kStart), {0.0, 0.3, 0.0});
  apply(diffWith(boxObject("box", end.translation(), 0.05)));
  const auto path = call<ComputeCartesianPath>("compute_cartesian_path", linesThrough({end}));
  ASSERT_TRUE(path.success) << path.message;
  EXPECT_GT(path.fraction, 0.0);
  EXPECT_LT(path.fraction, 1.0);
  EXPECT_NE(std::string::npos, path.message.find("box")) << path.message;
  expectFree(statesAlong(path.trajectory, 20));
  ComputeCartesianPath::Request far = linesThrough({moved(tipPose(kStart), {2.0, 0.0, 0.0})});
  const auto ends_early = call<ComputeCartesianPath>("compute_cartesian_path", far);
  ASSERT_TRUE(ends_early.success) << ends_early.message;
  EXPECT_LT(ends_early.fraction, 1.0);
  EXPECT_NE("", ends_early.message);
}

TEST_F(StraightLinesService, HaveTimesIfTheRequestWantsThem)
{
  ComputeCartesianPath::Request request = linesThrough({moved(tipPose(kStart), {0.0, 0.0, 0.15})});
  request.times = 1;
  const auto path = call<ComputeCartesianPath>("compute_cartesian_path", request);
  ASSERT_TRUE(path.success) << path.message;
  const Eigen::Vector3d begin = tipPose(kStart).translation();
  for (std::size_t i = 0; i < path.trajectory.points.size(); ++i)
  {
    const auto& point = path.trajectory.points[i];
    ASSERT_EQ(6U, point.velocities.size());
    if (i > 0)
      EXPECT_GT(point.time_from_start, path.trajectory.points[i - 1].time_from_start);
    const Eigen::Vector3d palm = tipPose(stateOf(path.trajectory.joint_names, point.positions.data())).translation();
    EXPECT_LE((palm - begin).head<2>().norm(), 2e-4);
  }
}

TEST_F(StraightLinesService, RefuseWrongRequestsInOneLine)
{
  const ComputeCartesianPath::Request good = linesThrough({moved(tipPose(kStart), {0.0, 0.0, 0.1})});
  const auto refused =
      [&good](const std::string& text, const std::function<void(ComputeCartesianPath::Request&)>& spoil)
  {
    ComputeCartesianPath::Request request = good;
    spoil(request);
    expectRefused<ComputeCartesianPath>("compute_cartesian_path", request, text);
  };
  using Request = ComputeCartesianPath::Request;
  refused("there is no waypoint", [](Request& r) { r.waypoints.clear(); });
  Request unknown_frame = good;
  unknown_frame.waypoints[0].header.frame_id = "nowhere";
  expectRefused<ComputeCartesianPath>("compute_cartesian_path", unknown_frame, "waypoints[0]: frame 'nowhere'",
                                      AnswerStatus::UNAVAILABLE);
  refused(
      "the scene has no frame 'plam'; did you mean 'palm'", [](Request& r) { r.link = "plam"; });
  refused(
      "waypoints[0]: the quaternion of the orientation has the length 0",
      [](Request& r) { r.waypoints[0].pose.orientation = geometry_msgs::Quaternion(); });
  refused(
      "max_step is -1; it must be at least 0", [](Request& r) { r.max_step = -1.0; });
  refused(
      "deviation", [](Request& r) { r.max_deviation = 1e-9; });
  refused("steps; they must have less than 1000000", [](Request& r) { r.max_step = 1e-9; });
  refused("start has 2 rows; give one state",
          [](Request& r)
          {
            r.start_names = {"waist"};
            r.start = {0.0, 0.1};  // two rows
          });
  refused(
      "the start is out of bounds: ",
      [](Request& r)
      {
        r.start_names = {"waist"};
        r.start = {4.0};
      });
  refused(
      "max_velocity_scaling_factor", [](Request& r) { r.max_velocity_scaling_factor = 2.0; });
  refused("path_constraints: two ranges of joint 'waist' contradict each other",
          [](Request& r)
          {
            for (const double position : {0.0, 1.0})
            {
              auto& joint = r.path_constraints.joint_constraints.emplace_back();
              joint.joint_name = "waist";
              joint.position = position;
              joint.tolerance_above = joint.tolerance_below = 0.1;
            }
          });
}
}  // namespace
}  // namespace gpu_planning_scene::core
