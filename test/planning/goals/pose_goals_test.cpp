#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/inverse_kinematics.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "model/real_robots.h"
#include "scene/frame.h"
#include "support/states_along.h"

// Plans whose goals are poses, and plans under path constraints, for the panda between two boxes.
namespace gpu_planning_scene::core
{
namespace
{
constexpr char kArm[] = "panda_arm";
constexpr char kTip[] = "panda_link8";

class PoseGoals : public testing::Test
{
 protected:
  void SetUp() override
  {
    SKIP_WITHOUT(panda());
    static const std::shared_ptr<const RobotModel> robot = panda().load();
    robot_ = robot;
    query_.group = kArm;
    query_.start = armAt(-1.2);
    query_.seconds = 20.0;
    query_.seed = 1;
  }

  /// The hand points down, and the first joint has this angle.
  std::vector<double> armAt(double angle) const
  {
    std::vector<double> state = robot_->defaultState();
    const std::vector<double> values = {angle, -0.3, 0.0, -2.0, 0.0, 1.7, 0.8};
    for (std::size_t i = 0; i < values.size(); ++i)
      state[static_cast<std::size_t>(robot_->variableIndex("panda_joint" + std::to_string(i + 1)))] = values[i];
    return state;
  }

  Eigen::Isometry3d tipAt(const std::vector<double>& state) const { return linkPose(*robot_, tip(), state.data()); }

  int tip() const { return robot_->linkIndex(kTip); }

  KinematicConstraints poseOf(const Eigen::Isometry3d& pose) const
  {
    return KinematicConstraints::pose(tip(), Eigen::Isometry3d::Identity(), pose, 1e-4, 1e-3);
  }

  /// The tip's z axis points down, up to a tilt.
  KinematicConstraints pointingDown(double tilt) const
  {
    KinematicConstraints constraints;
    OrientationConstraint down;
    down.link = tip();
    down.wanted = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
    down.tolerance = {tilt, tilt, 4.0};
    constraints.orientations.push_back(down);
    return constraints;
  }

  void addBox(const std::string& name, const Eigen::Vector3d& place, const Eigen::Vector3d& size)
  {
    WorldObject object;
    object.id = name;
    object.pose.translation() = place;
    object.shapes.push_back({Box{size}, Eigen::Isometry3d::Identity()});
    objects_.push_back(object);
  }

  PlanningResult plan()
  {
    auto scene = std::make_shared<PlanningScene>(robot_);
    scene->current_state = query_.start;
    scene->objects = objects_;
    scene_ = scene;
    return planMotion(scene, std::make_shared<CpuChecker>(scene, CheckerOptions()), query_,
                      PlannerFactoryOf<BatchRrtConnect>());
  }

  /// The error of a query that is refused.
  std::string refusal()
  {
    try
    {
      plan();
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  }

  void expectFree(const std::vector<std::vector<double>>& rows) const
  {
    const std::vector<double> states = statesAlong(*robot_, rows);
    const std::size_t count = states.size() / robot_->variables().size();
    CpuChecker checker(scene_, CheckerOptions());
    const std::vector<std::uint8_t> valid = checker.check(states.data(), count, kArm).valid;
    EXPECT_EQ(0, std::count(valid.begin(), valid.end(), 0));
  }

  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const PlanningScene> scene_;
  std::vector<WorldObject> objects_;
  PlanningQuery query_;
};

TEST_F(PoseGoals, AreReachedWithoutCollision)
{
  addBox("post", {0.5, 0.0, 0.8}, {0.1, 0.1, 1.6});
  const Eigen::Isometry3d pose = tipAt(armAt(1.2));
  query_.goal_regions = {poseOf(pose)};
  const PlanningResult result = plan();
  ASSERT_EQ(PlanningStatus::Solved, result.status) << result.message;
  const Eigen::Isometry3d reached = tipAt(result.waypoints.back());
  EXPECT_LE((reached.translation() - pose.translation()).norm(), 1e-4);
  EXPECT_LE(Eigen::AngleAxisd(reached.linear().transpose() * pose.linear()).angle(), 1e-3);
  EXPECT_EQ(query_.start, result.waypoints.front());
  expectFree(result.waypoints);
}

TEST_F(PoseGoals, StandBesideGoalStates)
{
  Eigen::Isometry3d far = tipAt(armAt(1.2));
  far.translation().x() += 5.0;
  query_.goal_regions = {poseOf(far)};
  query_.goals = {armAt(0.5)};
  const PlanningResult result = plan();
  ASSERT_EQ(PlanningStatus::Solved, result.status) << result.message;
  EXPECT_EQ(armAt(0.5), result.waypoints.back());
}

TEST_F(PoseGoals, AndGoalStatesAreNamedIfAllOfThemAreInvalid)
{
  const std::vector<double> inside = armAt(0.5);
  addBox("crate", tipAt(inside).translation(), {0.2, 0.2, 0.2});
  Eigen::Isometry3d far = tipAt(armAt(1.2));
  far.translation().x() += 5.0;
  query_.goal_regions = {poseOf(far)};
  query_.goals = {inside};
  PlanningResult result = plan();
  EXPECT_EQ(PlanningStatus::GoalUnreachable, result.status);
  EXPECT_EQ(0U, result.message.find("the goal state is in collision: ")) << result.message;
  EXPECT_NE(std::string::npos, result.message.find("; the goal region is not reached: ")) << result.message;
  query_.goals.push_back(armAt(7.0));
  query_.goal_regions.push_back(poseOf(far));
  result = plan();
  EXPECT_EQ(0U, result.message.find("goal state 0 is in collision: ")) << result.message;
  EXPECT_NE(std::string::npos, result.message.find("; goal region 0 is not reached: ")) << result.message;
  EXPECT_NE(std::string::npos, result.message.find("; goal region 1 is not reached: ")) << result.message;
  query_.goals = {armAt(-1.2)};
  EXPECT_EQ(PlanningStatus::Solved, plan().status);
}

TEST_F(PoseGoals, OutOfReachAreNamedWithTheirDistance)
{
  Eigen::Isometry3d far = tipAt(armAt(1.2));
  far.translation() = Eigen::Vector3d(2.0, 0.0, 0.5);
  query_.goal_regions = {poseOf(far)};
  const PlanningResult result = plan();
  EXPECT_EQ(PlanningStatus::GoalUnreachable, result.status);
  EXPECT_NE(std::string::npos, result.message.find(" m from the wanted position")) << result.message;
  EXPECT_TRUE(result.waypoints.empty());
}

TEST_F(PoseGoals, InsideAnObjectAreInCollisionWithIt)
{
  const Eigen::Isometry3d pose = tipAt(armAt(1.2));
  addBox("crate", pose.translation(), {0.2, 0.2, 0.2});
  query_.goal_regions = {poseOf(pose)};
  const PlanningResult result = plan();
  EXPECT_EQ(PlanningStatus::GoalInCollision, result.status);
  EXPECT_NE(std::string::npos, result.message.find("crate")) << result.message;
}

TEST_F(PoseGoals, WithTheSameSeedGiveTheSamePath)
{
  addBox("post", {0.5, 0.0, 0.8}, {0.1, 0.1, 1.6});
  query_.goal_regions = {poseOf(tipAt(armAt(1.2)))};
  const PlanningResult first = plan();
  ASSERT_EQ(PlanningStatus::Solved, first.status) << first.message;
  EXPECT_EQ(first.waypoints, plan().waypoints);
}

TEST_F(PoseGoals, AreOptimizedToShorterPaths)
{
  addBox("post", {0.5, 0.0, 0.8}, {0.1, 0.1, 1.6});
  query_.goal_regions = {poseOf(tipAt(armAt(1.2)))};
  query_.optimize_seconds = 0.3;
  const PlanningResult result = plan();
  ASSERT_EQ(PlanningStatus::Solved, result.status) << result.message;
  expectFree(result.waypoints);
}

TEST_F(PoseGoals, UnderPathConstraintsKeepThemBetweenWaypoints)
{
  constexpr double kTilt = 0.12;
  addBox("post", {0.5, 0.0, 0.4}, {0.1, 0.1, 0.8});
  query_.path_constraints = pointingDown(kTilt);
  // The hand is not upright at armAt(), so the start is projected first.
  const InverseKinematics upright(robot_, kArm, query_.path_constraints);
  ASSERT_TRUE(upright.project(query_.start.data()));
  std::vector<double> goal = armAt(1.2);
  ASSERT_TRUE(upright.project(goal.data()));
  query_.goal_regions = {poseOf(tipAt(goal))};
  const PlanningResult result = plan();
  ASSERT_EQ(PlanningStatus::Solved, result.status) << result.message;
  expectFree(result.waypoints);
  const std::vector<double> states = statesAlong(*robot_, result.waypoints);
  for (std::size_t i = 0; i < states.size(); i += robot_->variables().size())
  {
    const Eigen::Vector3d axis = linkPose(*robot_, tip(), &states[i]).linear().col(2);
    // Both Euler angles within the tolerance: the tilt is below the root of two times it.
    ASSERT_LT(std::acos(std::clamp(-axis.z(), -1.0, 1.0)), std::sqrt(2.0) * kTilt);
  }
}

TEST_F(PoseGoals, WithAStartOrGoalOutsidePathConstraintsAreNamed)
{
  query_.path_constraints = pointingDown(0.05);
  const InverseKinematics upright(robot_, kArm, query_.path_constraints);
  std::vector<double> inside = armAt(0.0);
  ASSERT_TRUE(upright.project(inside.data()));
  std::vector<double> outside = armAt(0.0);
  outside[static_cast<std::size_t>(robot_->variableIndex("panda_joint6"))] += 0.5;
  query_.start = outside;
  query_.goals = {inside};
  EXPECT_EQ(PlanningStatus::StartViolatesConstraints, plan().status);
  std::swap(query_.start, query_.goals.front());
  const PlanningResult result = plan();
  EXPECT_EQ(PlanningStatus::GoalViolatesConstraints, result.status);
  EXPECT_NE(std::string::npos, result.message.find("rad from the wanted orientation")) << result.message;
}

TEST_F(PoseGoals, ThatContradictThemselvesAreRefused)
{
  EXPECT_EQ("there is no goal; give at least one", refusal());
  query_.goal_regions = {poseOf(tipAt(armAt(1.2)))};
  query_.goal_regions.front().orientations.front().tolerance.setZero();
  EXPECT_NE(std::string::npos, refusal().find("a tolerance is 0")) << refusal();
  query_.goal_regions = {poseOf(tipAt(armAt(1.2)))};
  const int variable = robot_->variableIndex("panda_joint1");
  query_.goal_regions.front().addJoint(*robot_, variable, 0.0, 0.1);
  query_.goal_regions.front().addJoint(*robot_, variable, 0.2, 0.3);
  EXPECT_NE(std::string::npos, refusal().find("two ranges of joint 'panda_joint1' contradict each other")) << refusal();
  query_.goal_regions = {poseOf(tipAt(armAt(1.2)))};
  query_.goal_regions.front().positions.front().link = robot_->linkIndex("panda_link0");
  EXPECT_NE(std::string::npos, refusal().find("group 'panda_arm' has no joint that moves link 'panda_link0'"))
      << refusal();
}
}  // namespace
}  // namespace gpu_planning_scene::core
