// Inverse kinematics for joints of all types: solutions have the wanted poses by plain forward kinematics, keep limits
// and ranges, and repeat for a seed.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/inverse_kinematics.h"
#include "model/all_joints_robot.h"
#include "model/model_testing.h"
#include "scene/frame.h"
#include "support/pose_goals.h"
#include "support/repetitions.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::uint64_t kIkSeed = 42;

/// A chain of joints of one type: link_0 -joint_1-> link_1 ... Each joint is `lengths` metres along x from the last.
std::shared_ptr<const RobotModel> chainOf(const std::string& type, const std::vector<std::string>& axes, double limit,
                                          double length)
{
  std::string urdf = boxLink("link_0");
  for (std::size_t i = 1; i <= axes.size(); ++i)
    urdf += boxLink("link_" + std::to_string(i)) +
            jointXml("joint_" + std::to_string(i), type, "link_" + std::to_string(i - 1), "link_" + std::to_string(i),
                     "<origin xyz=\"" + std::to_string(i == 1 ? 0.0 : length) + " 0 0\"/><axis xyz=\"" + axes[i - 1] +
                         "\"/><limit lower=\"" + std::to_string(-limit) + "\" upper=\"" + std::to_string(limit) +
                         "\" effort=\"1\" velocity=\"1\"/>");
  urdf += boxLink("tip") + jointXml("last", "fixed", "link_" + std::to_string(axes.size()), "tip",
                                    "<origin xyz=\"" + std::to_string(length) + " 0 0\"/>");
  return robotOf(urdf, R"(<group name="arm"><chain base_link="link_0" tip_link="tip"/></group>)");
}

/// Three parallel joints: two lengths of 1 m in the plane, and a hand of 1 m.
std::shared_ptr<const RobotModel> planarArm(const std::string& type = "revolute", double limit = 3.0)
{
  return chainOf(type, {"0 0 1", "0 0 1", "0 0 1"}, limit, 1.0);
}

/// An elbow arm with six joints.
std::shared_ptr<const RobotModel> sixAxisArm()
{
  return chainOf("revolute", {"0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"}, 3.1, 0.4);
}

class Kinematic : public testing::Test
{
 protected:
  std::vector<double> randomState(const RobotModel& robot)
  {
    std::vector<double> state(robot.variables().size());
    robot.randomState(generator_, state.data());
    return state;
  }

  std::mt19937_64 generator_{kIkSeed};
  const testing::ScopedTrace trace_{__FILE__, __LINE__, "seed " + std::to_string(kIkSeed)};
};

void expectWithinLimits(const RobotModel& robot, const std::vector<double>& state)
{
  for (std::size_t i = 0; i < state.size(); ++i)
    if (const Variable& variable = robot.variables()[i]; variable.bounded)
    {
      EXPECT_GE(state[i], variable.lower) << variable.name;
      EXPECT_LE(state[i], variable.upper) << variable.name;
    }
}

IkOptions manySolutions()
{
  IkOptions options;
  options.max_solutions = 50;
  return options;
}

TEST_F(Kinematic, SolvesPosesWithJointsOfAllTypes)
{
  const auto robot = allJointsRobot();
  for (const char* name : {"middle", "end"})
    for (int i = 0; i < repetitions(30, 1000); ++i)
    {
      const int link = robot->linkIndex(name);
      const Isometry3d wanted = linkPose(*robot, link, randomState(*robot).data());
      const InverseKinematics kinematics(robot, "all", poseGoal(link, wanted));
      const IkSolutions found = kinematics.solve(randomState(*robot).data(), {});
      ASSERT_EQ(found.states.size(), 1u);
      expectPose(*robot, link, found.states[0], wanted);
      expectWithinLimits(*robot, found.states[0]);
      EXPECT_TRUE(kinematics.violation(found.states[0].data()).isNone());
    }
}

TEST_F(Kinematic, SolvesPosesOfAnArmWithSixJoints)
{
  const auto robot = sixAxisArm();
  const int tip = tipOf(*robot, robot->group("arm"));
  for (int i = 0; i < repetitions(100, 10000); ++i)
  {
    const Isometry3d wanted = linkPose(*robot, tip, randomState(*robot).data());
    const IkSolutions found =
        InverseKinematics(robot, "arm", poseGoal(tip, wanted)).solve(robot->defaultState().data(), {});
    ASSERT_EQ(found.states.size(), 1u) << "pose " << i;
    expectPose(*robot, tip, found.states[0], wanted);
    expectWithinLimits(*robot, found.states[0]);
  }
}

TEST_F(Kinematic, EqualSeedsGiveEqualSolutions)
{
  const auto robot = sixAxisArm();
  const int tip = tipOf(*robot, robot->group("arm"));
  const InverseKinematics kinematics(robot, "arm", poseGoal(tip, linkPose(*robot, tip, randomState(*robot).data())));
  const std::vector<double> given = randomState(*robot);
  IkOptions options = manySolutions();
  const IkSolutions first = kinematics.solve(given.data(), options);
  EXPECT_GT(first.states.size(), 1u);
  EXPECT_EQ(first.states, kinematics.solve(given.data(), options).states);
  options.seed = 2;
  EXPECT_NE(first.states, kinematics.solve(given.data(), options).states);
}

TEST_F(Kinematic, SolutionsDiffer)
{
  const auto robot = sixAxisArm();
  const int tip = tipOf(*robot, robot->group("arm"));
  const InverseKinematics kinematics(robot, "arm", poseGoal(tip, linkPose(*robot, tip, randomState(*robot).data())));
  const auto states = kinematics.solve(randomState(*robot).data(), manySolutions()).states;
  EXPECT_GT(states.size(), 3u);
  for (std::size_t i = 0; i < states.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
    {
      double largest = 0.0;
      for (std::size_t variable = 0; variable < states[i].size(); ++variable)
        largest = std::max(largest, std::abs(states[i][variable] - states[k][variable]));
      EXPECT_GE(largest, IkOptions().least_difference);
    }
}

TEST_F(Kinematic, BothQuaternionsOfARotationAreOneSolution)
{
  const auto robot = robotOf(boxLink("body"), R"(<virtual_joint name="fly" type="floating" parent_frame="world" )"
                                              R"(child_link="body"/><group name="all"><joint name="fly"/></group>)");
  for (int i = 0; i < 10; ++i)
  {
    const Isometry3d wanted = linkPose(*robot, 0, randomState(*robot).data());
    const std::vector<double> given = randomState(*robot);
    const auto states =
        InverseKinematics(robot, "all", poseGoal(0, wanted)).solve(given.data(), manySolutions()).states;
    ASSERT_EQ(states.size(), 1u);
    EXPECT_GE(Eigen::Map<const Eigen::Vector4d>(&states[0][3]).dot(Eigen::Map<const Eigen::Vector4d>(&given[3])), 0.0);
    // The numbers of the quaternion may all be 0, as of a state that nobody has set.
    const auto from_zeros =
        InverseKinematics(robot, "all", poseGoal(0, wanted)).solve(std::vector<double>(7, 0.0).data(), {}).states;
    ASSERT_EQ(from_zeros.size(), 1u);
    expectPose(*robot, 0, from_zeros[0], wanted);
  }
}

TEST_F(Kinematic, RangesOfJointsAreKept)
{
  const auto robot = planarArm();
  const int tip = robot->linkIndex("tip");
  KinematicConstraints constraints = positionGoal(tip, {1.2, 0.9, 0.0});
  constraints.joints = {{1, -2.8, -0.2}, {2, 0.5, 0.7}};
  const InverseKinematics kinematics(robot, "arm", constraints);
  const auto states = kinematics.solve(std::vector<double>{0.0, 1.0, 0.0}.data(), manySolutions()).states;
  ASSERT_FALSE(states.empty());
  for (const std::vector<double>& state : states)
  {
    EXPECT_TRUE(-2.8 <= state[1] && state[1] <= -0.2) << state[1];
    EXPECT_TRUE(0.5 <= state[2] && state[2] <= 0.7) << state[2];
    EXPECT_TRUE(kinematics.violation(state.data()).isNone());
    EXPECT_LT((linkPose(*robot, tip, state.data()).translation() - Vector3d(1.2, 0.9, 0.0)).norm(), kPoseTolerance);
  }
}

TEST_F(Kinematic, VariablesThatMoveNoConstrainedLinkKeepTheirValuesOrComeIntoTheirRange)
{
  const auto robot = planarArm();
  KinematicConstraints constraints =
      positionGoal(robot->linkIndex("link_2"), {0.6, 0.8, 0.0});  // joint_3 comes after it
  const std::vector<double> given = {0.1, 0.2, 1.5};
  EXPECT_EQ(InverseKinematics(robot, "arm", constraints).solve(given.data(), {}).states.at(0)[2], 1.5);
  constraints.joints = {{2, -1.0, 1.0}};
  EXPECT_EQ(InverseKinematics(robot, "arm", constraints).solve(given.data(), {}).states.at(0)[2], 1.0);
}

TEST_F(Kinematic, AnglesAreNearestToTheGivenState)
{
  const auto robot = planarArm("continuous");
  const int tip = robot->linkIndex("tip");
  const Isometry3d wanted = linkPose(*robot, tip, std::vector<double>{0.4, -0.8, 0.2}.data());
  const std::vector<double> given = {40.0, -21.0, 3.0};
  for (const std::vector<double>& state :
       InverseKinematics(robot, "arm", poseGoal(tip, wanted)).solve(given.data(), manySolutions()).states)
  {
    expectPose(*robot, tip, state, wanted);
    for (std::size_t i = 0; i < state.size(); ++i)
      EXPECT_LE(std::abs(state[i] - given[i]), M_PI + 1e-9);
  }
  // With limits, the nearest turn within them.
  const auto bounded = planarArm("revolute", 7.0);
  const std::vector<double> turned = {6.5, 6.5, -6.5};
  for (const std::vector<double>& state :
       InverseKinematics(bounded, "arm", poseGoal(tip, wanted)).solve(turned.data(), manySolutions()).states)
  {
    expectWithinLimits(*bounded, state);
    for (std::size_t i = 0; i < state.size(); ++i)
      for (const double turn : {-2.0 * M_PI, 2.0 * M_PI})
        if (std::abs(state[i] + turn) <= 7.0)
          EXPECT_LE(std::abs(state[i] - turned[i]), std::abs(state[i] + turn - turned[i])) << state[i];
  }
}

TEST_F(Kinematic, MimicJointsMoveWithTheirLeader)
{
  const std::string limits = R"(<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>)";
  const auto robot = robotOf(
      boxLink("a") + boxLink("b") + boxLink("c") + boxLink("d") + jointXml("lead", "revolute", "a", "b", limits) +
          jointXml("follow", "revolute", "b", "c",
                   R"(<origin xyz="1 0 0"/><mimic joint="lead" multiplier="-2" offset="0.5"/>)" + limits) +
          jointXml("end", "fixed", "c", "d", R"(<origin xyz="1 0 0"/>)"),
      R"(<group name="arm"><chain base_link="a" tip_link="d"/></group>)");
  for (const double lead : {-1.0, 0.2, 1.2})
  {
    const int link = robot->linkIndex("d");
    const Isometry3d wanted = linkPose(*robot, link, std::vector<double>{lead}.data());
    const std::vector<double> given = {lead + 0.4};
    const auto states = InverseKinematics(robot, "arm", poseGoal(link, wanted)).solve(given.data(), {}).states;
    ASSERT_EQ(states.size(), 1u);
    EXPECT_NEAR(states[0][0], lead, 1e-5);
  }
}

TEST_F(Kinematic, APositionIsEnoughForAnArmWithFewJoints)
{
  const auto robot = chainOf("revolute", {"0 0 1", "0 1 0", "0 1 0", "0 1 0", "1 0 0"}, 3.0, 0.4);
  const int tip = robot->linkIndex("tip");
  for (int i = 0; i < 20; ++i)
  {
    const Vector3d wanted = linkPose(*robot, tip, randomState(*robot).data()).translation();
    const auto states =
        InverseKinematics(robot, "arm", positionGoal(tip, wanted)).solve(robot->defaultState().data(), {}).states;
    ASSERT_EQ(states.size(), 1u);
    EXPECT_LT((linkPose(*robot, tip, states[0].data()).translation() - wanted).norm(), kPoseTolerance);
  }
}

TEST_F(Kinematic, TwoLinksAreConstrainedAtOnce)
{
  const std::string limits = R"(<limit lower="-2.5" upper="2.5" effort="1" velocity="1"/>)";
  std::string urdf = boxLink("foot") + boxLink("torso") +
                     jointXml("turn", "revolute", "foot", "torso", R"(<axis xyz="0 0 1"/>)" + limits);
  for (const std::string side : {"left", "right"})
    urdf += boxLink(side + "_arm") + boxLink(side + "_hand") +
            jointXml(side + "_shoulder", "revolute", "torso", side + "_arm",
                     "<origin xyz=\"0 " + std::string(side == "left" ? "0.3" : "-0.3") + " 0\"/><axis xyz=\"0 1 0\"/>" +
                         limits) +
            jointXml(side + "_elbow", "revolute", side + "_arm", side + "_hand",
                     R"(<origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>)" + limits);
  const auto robot = robotOf(urdf, R"(<group name="body"><joint name="turn"/><joint name="left_shoulder"/>)"
                                   R"(<joint name="left_elbow"/><joint name="right_shoulder"/>)"
                                   R"(<joint name="right_elbow"/></group>)");
  const std::vector<int> hands = {robot->linkIndex("left_hand"), robot->linkIndex("right_hand")};
  for (int i = 0; i < 20; ++i)
  {
    const std::vector<double> state = randomState(*robot);
    KinematicConstraints both = poseGoal(hands[0], linkPose(*robot, hands[0], state.data()));
    const KinematicConstraints right = poseGoal(hands[1], linkPose(*robot, hands[1], state.data()));
    both.positions.push_back(right.positions[0]);
    both.orientations.push_back(right.orientations[0]);
    const auto states = InverseKinematics(robot, "body", both).solve(robot->defaultState().data(), {}).states;
    ASSERT_EQ(states.size(), 1u);
    for (const int hand : hands)
      expectPose(*robot, hand, states[0], linkPose(*robot, hand, state.data()));
  }
}

TEST_F(Kinematic, AnUnreachablePoseGivesTheNearestState)
{
  const auto robot = planarArm();
  const InverseKinematics kinematics(robot, "arm", positionGoal(robot->linkIndex("tip"), {0.0, 3.5, 0.0}));
  const IkSolutions found = kinematics.solve(robot->defaultState().data(), {});
  EXPECT_TRUE(found.states.empty());
  EXPECT_EQ(found.attempts, IkOptions().max_attempts);
  ASSERT_EQ(found.nearest.size(), 3u);
  EXPECT_NEAR(kinematics.violation(found.nearest.data()).position, 0.5, 0.01);
  EXPECT_NEAR(linkPose(*robot, robot->linkIndex("tip"), found.nearest.data()).translation().y(), 3.0, 0.01);
}

TEST_F(Kinematic, AProjectionStaysNear)
{
  const auto robot = sixAxisArm();
  const int tip = tipOf(*robot, robot->group("arm"));
  int succeeded = 0;
  for (int i = 0; i < 50; ++i)
  {
    const std::vector<double> at = randomState(*robot);
    const InverseKinematics kinematics(robot, "arm", positionGoal(tip, linkPose(*robot, tip, at.data()).translation()));
    std::vector<double> state = at;
    for (double& value : state)
      value += 0.05;
    const std::vector<double> before = state;
    if (!kinematics.project(state.data()))
      continue;
    ++succeeded;
    EXPECT_TRUE(kinematics.violation(state.data()).isNone());
    expectWithinLimits(*robot, state);
    for (std::size_t k = 0; k < state.size(); ++k)
      EXPECT_NEAR(state[k], before[k], 1.0);
  }
  EXPECT_GE(succeeded, 45);
}

TEST_F(Kinematic, ASearchCanBeStopped)
{
  const auto robot = planarArm();
  const InverseKinematics kinematics(robot, "arm", positionGoal(robot->linkIndex("tip"), {0.0, 3.5, 0.0}));
  int calls = 0;
  EXPECT_EQ(kinematics.solve(robot->defaultState().data(), {}, [&] { return ++calls > 3; }).attempts, 3u);
}

TEST_F(Kinematic, TheTipIsTheLastLinkOfAChain)
{
  const auto robot = planarArm();
  EXPECT_EQ(tipOf(*robot, robot->group("arm")), robot->linkIndex("tip"));
  const std::string groups = R"(<group name="both"><joint name="arm_2"/><joint name="pan"/></group>)"
                             R"(<group name="grip"><joint name="left"/><joint name="right"/></group>)";
  const auto tree = robotOf(armUrdf(), groups);
  EXPECT_EQ(tipOf(*tree, tree->group("grip")), tree->linkIndex("finger_left"));
  EXPECT_EQ(errorOf([&] { tipOf(*tree, tree->group("both")); }),
            "the joints of group 'both' are not one chain ('pan' is on another branch); name the link whose pose is "
            "wanted");
}

TEST_F(Kinematic, EachWrongInputHasItsError)
{
  const auto robot = planarArm();
  const int tip = robot->linkIndex("tip");
  const auto fault = [&](const std::string& group, const KinematicConstraints& constraints)
  { return errorOf([&] { InverseKinematics(robot, group, constraints); }); };
  EXPECT_EQ(fault("legs", positionGoal(tip, Vector3d::Zero())), "robot 'test' has no group 'legs'; its groups: arm");
  EXPECT_EQ(fault("arm", positionGoal(0, Vector3d::Zero())), "group 'arm' has no joint that moves link 'link_0'");
  EXPECT_EQ(fault("arm", positionGoal(9, Vector3d::Zero())),
            "the list of constraints names link 9, which the robot does not have");
  const auto tree = robotOf(armUrdf(), R"(<group name="arm"><joint name="arm_1"/></group>)");
  KinematicConstraints beyond = positionGoal(tree->linkIndex("upper"), Vector3d::Zero());
  beyond.joints = {{tree->variableIndex("pan"), 0.0, 1.0}};
  EXPECT_EQ(errorOf([&] { InverseKinematics(tree, "arm", beyond); }),
            "the list of constraints has a range of joint 'pan', which group 'arm' does not move");
  const InverseKinematics kinematics(robot, "arm", positionGoal(tip, Vector3d::Zero()));
  IkOptions none;
  none.max_attempts = 0;
  EXPECT_EQ(errorOf([&] { kinematics.solve(robot->defaultState().data(), none); }),
            "inverse kinematics needs at least one attempt and one solution");
}
}  // namespace
}  // namespace gpu_planning_scene::core
