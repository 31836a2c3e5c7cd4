#include "gpu_planning_scene/planning/path_constraints.h"

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/interpolation.h"
#include "scene/frame.h"
#include "support/arms.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A kind of constraints around the pose that a link has in a state.
struct Kind
{
  std::string name;
  KinematicConstraints (*around)(int link, const Eigen::Isometry3d& pose, double size);
};

KinematicConstraints sphere(int link, const Eigen::Isometry3d& pose, double size)
{
  KinematicConstraints constraints;
  constraints.positions.push_back({link, {0.05, 0.02, 0.1}, pose, Sphere{size}});
  constraints.positions.back().pose.translation() = pose * Eigen::Vector3d(0.05, 0.02, 0.1);
  return constraints;
}

KinematicConstraints box(int link, const Eigen::Isometry3d& pose, double size)
{
  KinematicConstraints constraints;
  constraints.positions.push_back({link, Eigen::Vector3d::Zero(), pose, Box{{size, 2.0 * size, 5.0}}});
  return constraints;
}

KinematicConstraints orientation(int link, const Eigen::Isometry3d& pose, double size,
                                 OrientationConstraint::Parameterization parameterization)
{
  KinematicConstraints constraints;
  constraints.orientations.push_back(
      {link, Eigen::Matrix3d::Identity(), pose.linear(), {size, 1.5 * size, 4.0}, parameterization, pose.linear()});
  return constraints;
}

KinematicConstraints eulerAngles(int link, const Eigen::Isometry3d& pose, double size)
{
  return orientation(link, pose, size, OrientationConstraint::Parameterization::XyzEulerAngles);
}

KinematicConstraints rotationVector(int link, const Eigen::Isometry3d& pose, double size)
{
  return orientation(link, pose, size, OrientationConstraint::Parameterization::RotationVector);
}

class PathConstraintsOfArms : public testing::TestWithParam<Kind>
{
};

TEST_P(PathConstraintsOfArms, AreNeverProvenForAMotionThatViolatesThem)
{
  constexpr int kMotions = repetitions(120, 3000);
  constexpr int kSamples = 400;
  const std::vector<Arm>& arms = realArms();
  if (arms.empty())
    GTEST_SKIP() << "there are no real robots";
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::size_t proven = 0;
  std::size_t refused = 0;
  for (const Arm& arm : arms)
  {
    const RobotModel& robot = *arm.robot;
    const int tip = tipOf(robot, robot.group(arm.group));
    std::vector<double> from(robot.variables().size());
    std::vector<double> state(from.size());
    for (int i = 0; i < kMotions; ++i)
    {
      robot.randomState(generator, robot.defaultState().data(), from.data());
      std::vector<double> to = from;
      const double reach = 0.5 * part(generator) * part(generator);
      for (const int variable : robot.group(arm.group).variables)
        to[static_cast<std::size_t>(variable)] += reach * (2.0 * part(generator) - 1.0);
      const PathConstraints constraints(
          arm.robot, arm.group,
          GetParam().around(tip, linkPose(robot, tip, from.data()), 0.02 + 0.4 * part(generator)));
      if (!constraints.holdAlong(from.data(), to.data()))
      {
        ++refused;
        continue;
      }
      ++proven;
      for (int k = 0; k <= kSamples; ++k)
      {
        interpolate(robot, from.data(), to.data(), static_cast<double>(k) / kSamples, state.data());
        ASSERT_LE(constraints.violation(state.data()).sum(), 1e-12) << arm.name << ", motion " << i << ", sample " << k;
      }
    }
  }
  EXPECT_GT(proven, 20U);
  EXPECT_GT(refused, 20U);
}

TEST_P(PathConstraintsOfArms, AreProvenForShortMotionsWithinThem)
{
  const std::vector<Arm>& arms = realArms();
  if (arms.empty())
    GTEST_SKIP() << "there are no real robots";
  for (const Arm& arm : arms)
  {
    const RobotModel& robot = *arm.robot;
    const int tip = tipOf(robot, robot.group(arm.group));
    const std::vector<double> from = robot.defaultState();
    std::vector<double> to = from;
    const std::vector<int>& variables = robot.group(arm.group).variables;
    to[static_cast<std::size_t>(variables.front())] += 0.01;
    const PathConstraints constraints(arm.robot, arm.group,
                                      GetParam().around(tip, linkPose(robot, tip, from.data()), 0.2));
    EXPECT_TRUE(constraints.holdAlong(from.data(), to.data())) << arm.name;
  }
}

TEST_P(PathConstraintsOfArms, AreReachedByProjection)
{
  const std::vector<Arm>& arms = realArms();
  if (arms.empty())
    GTEST_SKIP() << "there are no real robots";
  std::mt19937_64 generator(kSeed);
  for (const Arm& arm : arms)
  {
    const RobotModel& robot = *arm.robot;
    const int tip = tipOf(robot, robot.group(arm.group));
    std::vector<double> state(robot.variables().size());
    std::size_t reached = 0;
    constexpr std::size_t kStates = 50;
    for (std::size_t i = 0; i < kStates; ++i)
    {
      robot.randomState(generator, robot.defaultState().data(), state.data());
      const PathConstraints constraints(arm.robot, arm.group,
                                        GetParam().around(tip, linkPose(robot, tip, state.data()), 0.1));
      for (const int variable : robot.group(arm.group).variables)
        state[static_cast<std::size_t>(variable)] += i % 2 == 0 ? 0.1 : -0.1;
      if (!constraints.project(state.data()))
        continue;
      ++reached;
      EXPECT_TRUE(constraints.violation(state.data()).isNone()) << arm.name;
    }
    EXPECT_GT(reached, kStates / 2) << arm.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, PathConstraintsOfArms,
                         testing::Values(Kind{"sphere", sphere}, Kind{"box", box}, Kind{"euler", eulerAngles},
                                         Kind{"rotation_vector", rotationVector}),
                         [](const auto& kind) { return kind.param.name; });

/// A robot with a continuous joint. `more`: further elements of its URDF.
std::shared_ptr<const RobotModel> turningRobot(const std::string& more = "")
{
  const std::string urdf =
      "<robot name='r'><link name='a'/><link name='b'/><joint name='turn' type='continuous'><parent link='a'/>"
      "<child link='b'/><axis xyz='0 0 1'/></joint>" +
      more + "</robot>";
  return RobotModel::fromXml(urdf, "<robot name='r'><group name='g'><joint name='turn'/></group></robot>",
                             RobotModelOptions());
}

TEST(PathConstraints, OfJointsCountWholeTurnsOfContinuousJointsOnce)
{
  const auto robot = turningRobot();
  KinematicConstraints constraints;
  constraints.addJoint(*robot, 0, 3.0, 3.3);
  const PathConstraints path(robot, "g", constraints);
  const double within = -M_PI + 0.1;
  const double other = M_PI - 0.05;
  const double outside = 0.0;
  EXPECT_TRUE(path.holdAlong(&within, &other));
  EXPECT_FALSE(path.holdAlong(&within, &outside));
}

TEST(PathConstraints, OfAContinuousJointAreNotProvenWhereItTurnsTheShortWayOutsideItsRange)
{
  const auto robot = turningRobot();
  KinematicConstraints constraints;
  constraints.addJoint(*robot, 0, -3.0, 3.0);
  const PathConstraints path(robot, "g", constraints);
  const double low = -2.9;
  const double middle = 0.2;
  const double high = 2.9;
  const double high_turned = high - 2.0 * M_PI;
  EXPECT_FALSE(path.holdAlong(&low, &high));  // through pi
  EXPECT_FALSE(path.holdAlong(&high, &low));
  EXPECT_FALSE(path.holdAlong(&low, &high_turned));
  EXPECT_TRUE(path.holdAlong(&low, &middle));
  EXPECT_TRUE(path.holdAlong(&middle, &high_turned));
  KinematicConstraints any;
  any.addJoint(*robot, 0, -3.2, 3.2);
  EXPECT_TRUE(PathConstraints(robot, "g", any).holdAlong(&low, &high));
}

TEST(PathConstraints, OfAContinuousJointWithAFollowerAreNotProvenForAWholeTurn)
{
  // The follower turns by half as much, so the joint moves from 0 to a whole turn through all angles between them.
  const auto robot = turningRobot(
      "<link name='c'/><joint name='half' type='continuous'><parent link='b'/>"
      "<child link='c'/><axis xyz='0 0 1'/><mimic joint='turn' multiplier='0.5'/></joint>");
  KinematicConstraints constraints;
  constraints.addJoint(*robot, 0, -0.1, 0.1);
  const PathConstraints path(robot, "g", constraints);
  const double start = 0.0;
  const double near = 0.05;
  const double turned = 2.0 * M_PI;
  EXPECT_TRUE(path.holdAlong(&start, &near));
  EXPECT_FALSE(path.holdAlong(&start, &turned));
}

TEST(PathConstraints, OfJointsTakeValuesAtTheEndsOfRangesAndInOtherTurns)
{
  const std::string urdf =
      "<robot name='r'><link name='a'/><link name='b'/><joint name='turn' type='continuous'><parent link='a'/>"
      "<child link='b'/><axis xyz='0 0 1'/></joint></robot>";
  const auto robot = RobotModel::fromXml(urdf, "<robot name='r'><group name='g'><joint name='turn'/></group></robot>",
                                         RobotModelOptions());
  for (const auto& [lower, upper] : {std::pair(0.1, 0.3), std::pair(0.07, 1.13), std::pair(6.2, 6.5)})
  {
    KinematicConstraints constraints;
    constraints.addJoint(*robot, 0, lower, upper);
    EXPECT_NO_THROW(constraints.validate(*robot, "the constraints"));
    const PathConstraints path(robot, "g", constraints);
    for (double value : {0.5 * (lower + upper), 0.5 * (lower + upper) - 2.0 * M_PI})
    {
      EXPECT_TRUE(path.violation(&value).isNone()) << value;
      double projected = value;
      EXPECT_TRUE(path.project(&projected));
      EXPECT_TRUE(path.violation(&projected).isNone());
      EXPECT_NEAR(0.0, std::remainder(projected - value, 2.0 * M_PI), 1e-9) << "it was fulfilled before";
    }
    double outside = upper + 0.2;
    EXPECT_TRUE(path.project(&outside));
    EXPECT_TRUE(path.violation(&outside).isNone()) << outside;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
