#include "gpu_planning_scene/planning/cartesian_path.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/math_constants.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/inverse_kinematics.h"
#include "model/model_testing.h"
#include "scene/frame.h"
#include "support/arms.h"
#include "support/repetitions.h"
#include "support/seed.h"
#include "support/states_along.h"

namespace gpu_planning_scene::core
{
namespace
{
/// An arm of realArms() with a random free state and a line from it.
class Lines : public testing::Test
{
 protected:
  void SetUp() override
  {
    arms_ = &realArms();
    if (arms_->empty())
      GTEST_SKIP() << "there are no real robots";
  }

  void use(const Arm& arm)
  {
    arm_ = &arm;
    tip_ = tipOf(*arm.robot, arm.robot->group(arm.group));
    auto scene = std::make_shared<PlanningScene>(arm.robot);
    scene->current_state = arm.robot->defaultState();
    setScene(scene);
    query_ = CartesianQuery();
    query_.group = arm.group;
    query_.link = tip_;
  }

  void setScene(const std::shared_ptr<const PlanningScene>& scene)
  {
    scene_ = scene;
    checker_ = std::make_shared<CpuChecker>(scene, CheckerOptions());
  }

  void drawStart()
  {
    query_.start.resize(arm_->robot->variables().size());
    do
      arm_->robot->randomState(generator_, scene_->current_state.data(), query_.start.data());
    while (checker_->check(query_.start.data(), 1, arm_->group).valid.front() == 0);
  }

  Eigen::Isometry3d start() const { return linkPose(*arm_->robot, tip_, query_.start.data()); }

  Eigen::Vector3d randomVector(double length)
  {
    std::normal_distribution<double> normal;
    return length * Eigen::Vector3d(normal(generator_), normal(generator_), normal(generator_)).normalized();
  }

  /// Draws starts until the lines that `set_lines` gives to the query are followed to their end.
  template <class SetLines>
  CartesianPath wholePath(const SetLines& set_lines)
  {
    CartesianPath path;
    for (int i = 0; i < 1000 && path.fraction < 1.0; ++i)
    {
      drawStart();
      set_lines();
      path = followLines(scene_, checker_, query_);
    }
    return path;
  }

  /// Calls `look` with states along the path.
  template <class Look>
  void alongPath(const CartesianPath& path, const Look& look) const
  {
    const std::vector<double> states = statesAlong(*arm_->robot, path.rows);
    for (std::size_t i = 0; i < states.size(); i += query_.start.size())
      look(&states[i]);
  }

  std::string refusal() const
  {
    try
    {
      followLines(scene_, checker_, query_);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  }

  const std::vector<Arm>* arms_ = nullptr;
  const Arm* arm_ = nullptr;
  int tip_ = -1;
  std::mt19937_64 generator_{kSeed};
  std::shared_ptr<const PlanningScene> scene_;
  std::shared_ptr<CpuChecker> checker_;
  CartesianQuery query_;
};

TEST_F(Lines, AreFollowedWithinTheDeviationAndTheJumpBoundAndWithoutCollision)
{
  for (const Arm& arm : *arms_)
  {
    use(arm);
    std::size_t whole = 0;
    for (int i = 0; i < repetitions(20, 400); ++i)
    {
      drawStart();
      Eigen::Isometry3d goal = start();
      goal.translation() += randomVector(0.15);
      goal.linear() = Eigen::AngleAxisd(0.2, randomVector(1.0)) * goal.linear();
      query_.waypoints = {goal};
      const CartesianPath path = followLines(scene_, checker_, query_);
      ASSERT_EQ(path.fraction == 1.0, path.message.empty()) << path.message;
      whole += path.fraction == 1.0 ? 1 : 0;
      const Eigen::Vector3d direction = (goal.translation() - start().translation()).normalized();
      alongPath(path,
                [&](const double* state)
                {
                  const Eigen::Isometry3d pose = linkPose(*arm.robot, tip_, state);
                  const Eigen::Vector3d from_start = pose.translation() - start().translation();
                  const double distance = (from_start - from_start.dot(direction) * direction).norm();
                  ASSERT_LE(distance, query_.max_deviation) << arm.name;
                  ASSERT_EQ(1, checker_->check(state, 1, arm.group).valid.front()) << arm.name;
                });
      for (std::size_t k = 1; k < path.rows.size(); ++k)
        for (const JointTravel& travel : jointTravel(*arm.robot, path.rows[k - 1].data(), path.rows[k].data()))
          ASSERT_LE(std::max(travel.angle, travel.length), query_.max_joint_step) << arm.name;
      const Eigen::Isometry3d end = linkPose(*arm.robot, tip_, path.rows.back().data());
      if (path.fraction == 1.0)
      {
        ASSERT_LE((end.translation() - goal.translation()).norm(), query_.max_deviation);
        ASSERT_LE(Eigen::AngleAxisd(end.linear().transpose() * goal.linear()).angle(), query_.max_rotation_deviation);
      }
    }
    EXPECT_GT(whole, 2U) << arm.name;  // many lines leave the reach of an arm soon
  }
}

TEST_F(Lines, EndWhereTheReachEnds)
{
  use(arms_->front());
  drawStart();
  query_.check_collisions = false;
  query_.waypoints = {start()};
  query_.waypoints.front().translation() += randomVector(5.0);
  const CartesianPath path = followLines(scene_, checker_, query_);
  EXPECT_LT(path.fraction, 0.5);
  EXPECT_FALSE(path.message.empty());
  EXPECT_EQ(query_.start, path.rows.front());
}

TEST_F(Lines, EndAtAnObstacleThatIsNamed)
{
  const Arm& arm = arms_->front();
  use(arm);
  const CartesianPath free_path = wholePath(
      [&]
      {
        query_.waypoints = {start()};
        query_.waypoints.front().translation() += randomVector(0.2);
      });
  ASSERT_EQ(1.0, free_path.fraction);
  auto blocked = std::make_shared<PlanningScene>(*scene_);
  WorldObject box;
  box.id = "box";
  box.pose.translation() = query_.waypoints.front().translation();
  box.shapes.push_back({Box{Eigen::Vector3d::Constant(0.02)}, Eigen::Isometry3d::Identity()});
  blocked->objects.push_back(box);
  setScene(blocked);
  if (checker_->check(query_.start.data(), 1, arm.group).valid.front() == 0)
    GTEST_SKIP() << "the box touches the start";
  const CartesianPath path = followLines(scene_, checker_, query_);
  EXPECT_LT(path.fraction, 1.0);
  EXPECT_NE(std::string::npos, path.message.find("box")) << path.message;
  query_.check_collisions = false;
  EXPECT_EQ(1.0, followLines(scene_, checker_, query_).fraction);
}

TEST_F(Lines, PassSeveralWaypoints)
{
  use(arms_->front());
  const CartesianPath path = wholePath(
      [&]
      {
        Eigen::Isometry3d first = start();
        first.translation().z() += 0.05;
        Eigen::Isometry3d second = first;
        second.translation().x() += 0.05;
        query_.waypoints = {first, second, start()};
      });
  ASSERT_EQ(1.0, path.fraction);
  for (const Eigen::Isometry3d& waypoint : query_.waypoints)
  {
    double least = 1.0;
    for (const std::vector<double>& row : path.rows)
      least = std::min(least, (linkPose(*arm_->robot, tip_, row.data()).translation() - waypoint.translation()).norm());
    EXPECT_LE(least, 1e-5);
  }
}

TEST_F(Lines, EndWherePathConstraintsEnd)
{
  use(arms_->front());
  CartesianPath path = wholePath(
      [&]
      {
        query_.waypoints = {start()};
        query_.waypoints.front().translation().z() += 0.1;
      });
  ASSERT_EQ(1.0, path.fraction);
  PositionConstraint below;
  below.link = tip_;
  below.pose.translation() = start().translation();
  below.region = Sphere{0.05};
  query_.path_constraints.positions.push_back(below);
  path = followLines(scene_, checker_, query_);
  EXPECT_NEAR(0.5, path.fraction, 0.11);
  EXPECT_NE(std::string::npos, path.message.find("path constraints are not proven to hold: ")) << path.message;
}

TEST_F(Lines, ThatPathConstraintsEndAreFreeUpToThere)
{
  const Arm& arm = arms_->front();
  use(arm);
  const CartesianPath whole = wholePath(
      [&]
      {
        query_.waypoints = {start()};
        query_.waypoints.front().translation() += randomVector(0.3);
      });
  ASSERT_EQ(1.0, whole.fraction);
  // The constraint ends at 0.8 of the line, and the box stands in its middle.
  const Eigen::Vector3d end = query_.waypoints.front().translation();
  PositionConstraint near;
  near.link = tip_;
  near.pose.translation() = start().translation();
  near.region = Sphere{0.24};
  query_.path_constraints.positions.push_back(near);
  auto blocked = std::make_shared<PlanningScene>(*scene_);
  WorldObject box;
  box.id = "box";
  box.pose.translation() = 0.5 * (start().translation() + end);
  box.shapes.push_back({Box{Eigen::Vector3d::Constant(0.02)}, Eigen::Isometry3d::Identity()});
  blocked->objects.push_back(box);
  setScene(blocked);
  ASSERT_EQ(1, checker_->check(query_.start.data(), 1, arm.group).valid.front()) << "the box touches the start";
  const CartesianPath path = followLines(scene_, checker_, query_);
  EXPECT_LT(path.fraction, 0.7);
  EXPECT_NE(std::string::npos, path.message.find("box")) << path.message;
  alongPath(path, [&](const double* state) { ASSERT_EQ(1, checker_->check(state, 1, arm.group).valid.front()); });
}

TEST_F(Lines, ThatNeedTooManyStatesEndWithThem)
{
  use(arms_->front());
  query_.check_collisions = false;
  CartesianPath path = wholePath(
      [&]
      {
        query_.waypoints = {start()};
        query_.waypoints.front().translation() += randomVector(0.3);
      });
  ASSERT_EQ(1.0, path.fraction);
  const std::vector<std::vector<double>> rows = path.rows;
  query_.max_rows = rows.size();
  EXPECT_EQ(rows, followLines(scene_, checker_, query_).rows);
  query_.max_deviation = 1e-6;  // halves the steps
  path = followLines(scene_, checker_, query_);
  EXPECT_EQ(query_.max_rows, path.rows.size());
  EXPECT_LT(path.fraction, 1.0);
  EXPECT_NE(std::string::npos, path.message.find("more than " + std::to_string(rows.size()) + " states to follow"))
      << path.message;
}

TEST_F(Lines, WithoutLengthTurnTheFrameWithinTheDeviation)
{
  for (const Arm& arm : *arms_)
  {
    use(arm);
    query_.check_collisions = false;
    std::size_t whole = 0;
    for (int i = 0; i < repetitions(30, 600); ++i)
    {
      drawStart();
      const Eigen::Vector3d axis = randomVector(1.0);
      Eigen::Isometry3d goal = start();
      goal.linear() = Eigen::AngleAxisd(0.6, axis) * goal.linear();
      goal.translation() += randomVector(i % 3 == 0 ? 0.0 : 1e-6);  // as after rounding
      query_.waypoints = {goal};
      const CartesianPath path = followLines(scene_, checker_, query_);
      whole += path.fraction == 1.0 ? 1 : 0;
      EXPECT_LT(path.rows.size(), 200U) << arm.name;
      const Eigen::Matrix3d first = start().linear();
      alongPath(path,
                [&](const double* state)
                {
                  const Eigen::Isometry3d pose = linkPose(*arm.robot, tip_, state);
                  ASSERT_LE((pose.translation() - start().translation()).norm(), query_.max_deviation) << arm.name;
                  // The rotation so far turns about the axis, but for the deviation.
                  const Eigen::Quaterniond turned(pose.linear() * first.transpose());
                  const Eigen::Quaterniond about(
                      Eigen::AngleAxisd(2.0 * std::atan2(turned.vec().dot(axis), turned.w()), axis));
                  ASSERT_LE(about.angularDistance(turned), query_.max_rotation_deviation) << arm.name;
                });
    }
    EXPECT_GT(whole, 2U) << arm.name;
  }
}

TEST_F(Lines, WithWrongInputAreRefusedInOneLine)
{
  use(arms_->front());
  drawStart();
  EXPECT_EQ("there is no waypoint; give at least one", refusal());
  query_.waypoints = {start()};
  query_.max_step = 0.0;
  EXPECT_EQ("the largest step is 0; it must be above 0", refusal());
  query_.max_step = 1e-12;
  query_.waypoints.front().translation().x() += 0.1;
  EXPECT_EQ("the lines have 1e+11 steps; they must have less than 1000000: take larger steps, or fewer waypoints",
            refusal());
  query_.max_step = 0.01;
  query_.max_rows = 10;
  EXPECT_EQ("the lines have 10 steps; they must have less than 10: take larger steps, or fewer waypoints", refusal());
  query_.max_rows = 1000;
  query_.waypoints.front().linear() *= 2.0;
  EXPECT_EQ(0U, refusal().find("waypoint 0")) << refusal();
  query_.waypoints = {start()};
  query_.start.pop_back();
  EXPECT_NE(std::string::npos, refusal().find("the start has")) << refusal();
  drawStart();
  query_.start[static_cast<std::size_t>(arm_->robot->group(arm_->group).variables.front())] = 100.0;
  EXPECT_NE(std::string::npos, refusal().find("the start is out of bounds")) << refusal();
}

TEST(LinesOfContinuousJoints, ContinueWithoutWholeTurns)
{
  const auto scene = std::make_shared<const PlanningScene>(
      robotOf("<link name='base'/><link name='upper'/><link name='fore'/><link name='hand'/>" +
                  jointXml("shoulder", "continuous", "base", "upper", "<axis xyz='0 0 1'/>") +
                  jointXml("elbow", "continuous", "upper", "fore", "<origin xyz='0.5 0 0'/><axis xyz='0 0 1'/>") +
                  jointXml("wrist", "continuous", "fore", "hand", "<origin xyz='0.5 0 0'/><axis xyz='0 0 1'/>"),
              "<group name='arm'><joint name='shoulder'/><joint name='elbow'/><joint name='wrist'/></group>"));
  const auto checker = std::make_shared<CpuChecker>(scene);
  // Each line is one step, whose descent may pass whole turns.
  CartesianQuery query;
  query.group = "arm";
  query.link = scene->robot->linkIndex("hand");
  query.max_step = query.max_rotation_step = query.max_joint_step = 10.0;
  query.max_deviation = query.max_rotation_deviation = 10.0;
  query.check_collisions = false;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> angle(-3.0, 3.0);
  std::size_t whole = 0;
  for (int i = 0; i < 200; ++i)
  {
    const std::vector<double> end = {angle(generator), angle(generator), angle(generator)};
    query.start = {angle(generator), angle(generator), 50.0 + angle(generator)};
    query.waypoints = {linkPose(*scene->robot, query.link, end.data())};
    const CartesianPath path = followLines(scene, checker, query);
    whole += path.fraction == 1.0 ? 1 : 0;
    for (std::size_t row = 1; row < path.rows.size(); ++row)
      for (std::size_t k = 0; k < end.size(); ++k)
        EXPECT_LE(std::abs(path.rows[row][k] - path.rows[row - 1][k]), kPi + 1e-9) << "line " << i << ", joint " << k;
  }
  EXPECT_GT(whole, 100U);
}

/// A base in the plane with a tool 0.2 m above it.
CartesianQuery sidewaysQuery(const RobotModel& robot)
{
  CartesianQuery query;
  query.group = "all";
  query.link = robot.linkIndex("tool");
  query.start = robot.defaultState();
  query.waypoints = {linkPose(robot, query.link, query.start.data())};
  query.waypoints.front().translation().y() += 0.05;
  return query;
}

std::shared_ptr<const RobotModel> driven(const std::string& motion_model)
{
  return robotOf(boxLink("base") + "<link name='tool'/>" +
                     jointXml("lift", "prismatic", "base", "tool", std::string("<origin xyz='0 0 0.2'/>") + kLimits),
                 "<virtual_joint name='world' type='planar' parent_frame='map' child_link='base'/>"
                 "<joint_property joint_name='world' property_name='motion_model' value='" +
                     motion_model +
                     "'/><group name='all'><joint name='world'/><joint name='lift'/></group>"
                     "<group name='arm'><joint name='lift'/></group>");
}

TEST(LinesOfABase, ThatDrivesOnlyAlongItsHeadingAreRefused)
{
  const auto follow = [](const std::string& motion_model, const std::string& group)
  {
    const auto scene = std::make_shared<const PlanningScene>(driven(motion_model));
    CartesianQuery query = sidewaysQuery(*scene->robot);
    query.group = group;
    return followLines(scene, std::make_shared<CpuChecker>(scene), query);
  };
  EXPECT_EQ(1.0, follow("holonomic", "all").fraction);
  EXPECT_EQ(
      "joint 'world' of group 'all' cannot be planned for: it drives only along its heading (motion_model diff_drive "
      "in the SRDF), and planned motions would drive sideways",
      errorOf([&] { follow("diff_drive", "all"); }));
  EXPECT_EQ("", errorOf([&] { follow("diff_drive", "arm"); }));
}
}  // namespace
}  // namespace gpu_planning_scene::core
