// Inverse kinematics with collision checks: real arms reach the poses of free states, and small robots show how
// collisions, stops and errors are reported.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/planning/collision_free_ik.h"
#include "model/model_testing.h"
#include "scene/frame.h"
#include "support/arms.h"
#include "support/fcl_agreement.h"
#include "support/pose_goals.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// The states of a group in which the robot is free. The other variables have the values of `given`.
std::vector<std::vector<double>> freeStates(const Arm& arm, StateChecker& checker, const std::vector<double>& given,
                                            std::size_t count, std::mt19937_64& generator)
{
  std::vector<std::vector<double>> states;
  std::vector<double> random(given.size());
  while (states.size() < count)
  {
    arm.robot->randomState(generator, random.data());
    std::vector<double> state = given;
    for (const int variable : arm.robot->group(arm.group).variables)
      state[static_cast<std::size_t>(variable)] = random[static_cast<std::size_t>(variable)];
    if (checker.check(state.data(), 1).valid.front() != 0)
      states.push_back(std::move(state));
  }
  return states;
}

/// A free state of the whole robot whose base stands at the origin.
std::vector<double> anyFreeState(const RobotModel& robot, StateChecker& checker, std::mt19937_64& generator)
{
  const std::vector<double> base = robot.defaultState();
  std::vector<double> state(base.size());
  do
    robot.randomState(generator, base.data(), state.data());
  while (checker.check(state.data(), 1).valid.front() == 0);
  return state;
}

void expectLimitsKept(const Arm& arm, const std::vector<double>& given, const std::vector<double>& state)
{
  const std::vector<int>& of_group = arm.robot->group(arm.group).variables;
  for (std::size_t i = 0; i < state.size(); ++i)
  {
    const Variable& variable = arm.robot->variables()[i];
    if (!std::binary_search(of_group.begin(), of_group.end(), static_cast<int>(i)))
      EXPECT_EQ(state[i], given[i]) << variable.name;
    else if (variable.bounded)
      EXPECT_TRUE(variable.lower <= state[i] && state[i] <= variable.upper) << variable.name << " is " << state[i];
  }
}

TEST(CollisionFreeIk, RealArmsReachThePosesOfFreeStates)
{
  const std::vector<Arm>& arms = realArms();
  if (arms.empty())
    GTEST_SKIP() << "none of the arms is here";
  for (const Arm& arm : arms)
  {
    SCOPED_TRACE(arm.name + ", seed " + std::to_string(kSeed));
    std::mt19937_64 generator(kSeed);
    const auto scene = std::make_shared<const PlanningScene>(arm.robot);
    CpuChecker checker(scene);
    const int tip = tipOf(*arm.robot, arm.robot->group(arm.group));
    const std::vector<double> given = anyFreeState(*arm.robot, checker, generator);
    std::vector<Isometry3d> poses;
    std::vector<KinematicConstraints> goals;
    for (const auto& state :
         freeStates(arm, checker, given, static_cast<std::size_t>(repetitions(30, 2000)), generator))
    {
      poses.push_back(linkPose(*arm.robot, tip, state.data()));
      goals.push_back(poseGoal(tip, poses.back()));
    }
    const auto results = solveCollisionFree(*scene, checker, arm.group, goals, given, {});
    ASSERT_EQ(results.size(), goals.size());
    std::vector<double> rows;
    for (std::size_t i = 0; i < results.size(); ++i)
    {
      ASSERT_EQ(results[i].status, IkStatus::Solved) << "pose " << i << ": " << results[i].message;
      ASSERT_EQ(results[i].states.size(), 1u);
      EXPECT_EQ(results[i].message, "");
      const std::vector<double>& state = results[i].states.front();
      expectPose(*arm.robot, tip, state, poses[i]);
      expectLimitsKept(arm, given, state);
      rows.insert(rows.end(), state.begin(), state.end());
    }
    CpuChecker other(scene, CheckerOptions{Reductions::none()});
    const BatchResult checked = other.check(rows.data(), results.size());
    EXPECT_EQ(checked.valid, std::vector<std::uint8_t>(results.size(), 1));
    EXPECT_EQ(compareWithFcl(*scene, rows, checked).failures, std::vector<std::string>());
  }
}

/// Two links of 1 m that turn in the plane. The elbow is a ball, so an obstacle at the elbow stops one of two
/// solutions.
std::shared_ptr<const RobotModel> elbowRobot()
{
  const std::string turn = R"(<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>)";
  const std::string ball = R"(<collision><geometry><sphere radius="0.1"/></geometry></collision>)";
  return robotOf(R"(<link name="foot"/><link name="upper"/><link name="elbow">)" + ball +
                     R"(</link><link name="hand">)" + ball + "</link>" +
                     jointXml("shoulder", "revolute", "foot", "upper", turn) +
                     jointXml("bend", "revolute", "upper", "elbow", R"(<origin xyz="1 0 0"/>)" + turn) +
                     jointXml("wrist", "fixed", "elbow", "hand", R"(<origin xyz="1 0 0"/>)"),
                 R"(<group name="arm"><joint name="shoulder"/><joint name="bend"/></group>)");
}

std::shared_ptr<const PlanningScene> sceneWithBall(const Vector3d& position)
{
  PlanningScene scene(elbowRobot());
  WorldObject ball;
  ball.id = "ball";
  ball.pose.translation() = position;
  ball.shapes.push_back({Sphere{0.2}});
  scene.objects.push_back(ball);
  return std::make_shared<const PlanningScene>(std::move(scene));
}

std::vector<CollisionFreeIkResult> solveElbow(const std::shared_ptr<const PlanningScene>& scene,
                                              const std::vector<Vector3d>& positions,
                                              const CollisionFreeIkOptions& options = {},
                                              const std::function<bool()>& stop = {})
{
  CpuChecker checker(scene);
  std::vector<KinematicConstraints> goals;
  for (const Vector3d& position : positions)
    goals.push_back(positionGoal(scene->robot->linkIndex("hand"), position));
  return solveCollisionFree(*scene, checker, "arm", goals, {0.2, 0.3}, options, stop);
}

// Both links reach (sqrt 2, 0) with the shoulder at +45 and -45 degrees.
const Vector3d kHand(M_SQRT2, 0.0, 0.0);
const Vector3d kElbowBelow(M_SQRT1_2, -M_SQRT1_2, 0.0);

TEST(CollisionFreeIk, ACollidingSolutionIsReplacedByAnother)
{
  const auto nearest = solveElbow(sceneWithBall({9.0, 0.0, 0.0}), {kHand});
  ASSERT_EQ(nearest[0].status, IkStatus::Solved);
  EXPECT_NEAR(nearest[0].states.at(0)[0], -M_PI_4, 1e-5);
  const auto other = solveElbow(sceneWithBall(kElbowBelow), {kHand});
  ASSERT_EQ(other[0].status, IkStatus::Solved);
  EXPECT_NEAR(other[0].states.at(0)[0], M_PI_4, 1e-5);
  CollisionFreeIkOptions options;
  options.check_collisions = false;
  EXPECT_NEAR(solveElbow(sceneWithBall(kElbowBelow), {kHand}, options)[0].states.at(0)[0], -M_PI_4, 1e-5);
}

TEST(CollisionFreeIk, TheMessageNamesTheCollidingBodies)
{
  const auto results = solveElbow(sceneWithBall(kHand), {kHand, {3.0, 0.0, 0.0}});
  EXPECT_EQ(results[0].status, IkStatus::InCollision);
  EXPECT_EQ(results[0].message,
            "no solution without collision: of 2 solutions, the nearest to the given state collides: hand and ball");
  EXPECT_TRUE(results[0].states.empty());
  EXPECT_EQ(results[1].status, IkStatus::NoSolution);
  const std::string expected = "no solution in 200 attempts: the nearest state is 0.99999";
  EXPECT_EQ(results[1].message.rfind(expected, 0), 0u) << results[1].message;
}

TEST(CollisionFreeIk, SolutionsAreSortedByTheirDistance)
{
  CollisionFreeIkOptions options;
  options.ik.max_solutions = 10;
  const auto results = solveElbow(sceneWithBall({9.0, 0.0, 0.0}), {kHand, {0.0, 1.5, 0.0}}, options);
  for (const CollisionFreeIkResult& result : results)
  {
    ASSERT_EQ(result.states.size(), 2u);
    ASSERT_EQ(result.distances.size(), 2u);
    EXPECT_LT(result.distances[0], result.distances[1]);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_DOUBLE_EQ(result.distances[i], std::hypot(result.states[i][0] - 0.2, result.states[i][1] - 0.3));
  }
}

TEST(CollisionFreeIk, ARedundantArmHasSeveralSolutions)
{
  const std::vector<Arm>& arms = realArms();
  const auto arm = std::find_if(arms.begin(), arms.end(), [](const Arm& each) { return each.name == "panda"; });
  if (arm == arms.end())
    GTEST_SKIP() << "panda is not here";
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  const auto scene = std::make_shared<const PlanningScene>(arm->robot);
  CpuChecker checker(scene);
  const std::vector<double> given = anyFreeState(*arm->robot, checker, generator);
  const int tip = tipOf(*arm->robot, arm->robot->group(arm->group));
  const Isometry3d wanted = linkPose(*arm->robot, tip, freeStates(*arm, checker, given, 1, generator).front().data());
  CollisionFreeIkOptions options;
  options.ik.max_solutions = 8;
  const auto result = solveCollisionFree(*scene, checker, arm->group, {poseGoal(tip, wanted)}, given, options).front();
  EXPECT_EQ(result.states.size(), 8u);
  EXPECT_TRUE(std::is_sorted(result.distances.begin(), result.distances.end()));
  for (const std::vector<double>& state : result.states)
  {
    expectPose(*arm->robot, tip, state, wanted);
    EXPECT_EQ(checker.check(state.data(), 1).valid.front(), 1);
  }
  for (std::size_t i = 0; i < result.states.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
    {
      double largest = 0.0;
      for (std::size_t v = 0; v < given.size(); ++v)
        largest = std::max(largest, std::abs(result.states[i][v] - result.states[k][v]));
      EXPECT_GE(largest, options.ik.least_difference);
    }
}

TEST(CollisionFreeIk, ManyGoalsAreSolvedAsEachAlone)
{
  const auto scene = sceneWithBall(kElbowBelow);
  std::vector<Vector3d> positions;
  for (int i = 0; i < 30; ++i)
    positions.emplace_back(1.9 * std::cos(0.2 * i), 1.2 * std::sin(0.2 * i), 0.0);
  const auto together = solveElbow(scene, positions);
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    const auto alone = solveElbow(scene, {positions[i]}).front();
    EXPECT_EQ(together[i].status, alone.status);
    EXPECT_EQ(together[i].states, alone.states);
    EXPECT_EQ(together[i].message, alone.message);
  }
}

TEST(CollisionFreeIk, AValueThatTheSearchKeepsMustBeWithinItsLimits)
{
  // Behind the wrist, the group moves a finger and a joint without a range. A passive joint moves the hand.
  const std::string turn = "<axis xyz='0 0 1'/><limit lower='-3' upper='3' effort='1' velocity='1'/>";
  const auto robot =
      robotOf("<link name='foot'/><link name='upper'/><link name='lever'/><link name='hand'/>" + boxLink("finger") +
                  boxLink("cover") + jointXml("shoulder", "revolute", "foot", "upper", turn) +
                  jointXml("spring", "revolute", "upper", "lever", "<origin xyz='1 0 0'/>" + turn) +
                  jointXml("bend", "revolute", "lever", "hand", turn) +
                  jointXml("grip", "prismatic", "hand", "finger",
                           "<origin xyz='2 0 0'/><limit lower='0' upper='0.04' effort='1' velocity='1'/>") +
                  jointXml("screw", "revolute", "hand", "cover",
                           "<origin xyz='4 0 0'/><limit lower='0.5' upper='0.5' effort='1' velocity='1'/>"),
              "<passive_joint name='spring'/><group name='all'><joint name='shoulder'/><joint name='spring'/>"
              "<joint name='bend'/><joint name='grip'/><joint name='screw'/></group>"
              "<group name='arm'><joint name='shoulder'/><joint name='bend'/></group>");
  const auto scene = std::make_shared<const PlanningScene>(robot);
  CpuChecker checker(scene);
  const auto solve = [&](const std::string& group, double spring, double grip, double screw)
  {
    const std::vector<double> state = {-3.5, spring, 3.5, grip, screw};
    const KinematicConstraints goal = positionGoal(robot->linkIndex("hand"), {0.0, 1.0, 0.0});
    return solveCollisionFree(*scene, checker, group, {goal, goal}, state, {}).front();
  };
  const auto fault = [&](double spring, double grip, double screw)
  { return errorOf([&] { solve("all", spring, grip, screw); }); };
  const std::string must_be = "the given state must be within the limits of the joints that the search does not move: ";
  EXPECT_EQ(fault(0.0, 0.5, 0.5), must_be + "joint 'grip' is 0.5, outside its limits 0 to 0.04");
  EXPECT_EQ(fault(0.0, 0.02, 0.51), must_be + "joint 'screw' is 0.51, outside its limits 0.5 to 0.5 rad");
  EXPECT_EQ(fault(-3.1, 0.5, 0.5),
            must_be + "joint 'spring' is -3.1, outside its limits -3 to 3 rad; 1 more value is outside the limits");
  // A measured value may be outside by rounding. The solution is not.
  const CollisionFreeIkResult rounded = solve("all", 0.0, 0.04 + 9e-7, 0.5 - 9e-7);
  ASSERT_EQ(rounded.status, IkStatus::Solved) << rounded.message;
  expectLimitsKept({"", robot, "all", "", ""}, {}, rounded.states.front());
  EXPECT_EQ(solve("arm", 0.0, 0.5, 0.6).status, IkStatus::Solved) << "values outside the group may be anything";
}

TEST(CollisionFreeIk, ASearchCanBeStopped)
{
  const auto results = solveElbow(sceneWithBall({9.0, 0.0, 0.0}), {kHand, kHand}, {}, [] { return true; });
  for (const CollisionFreeIkResult& result : results)
  {
    EXPECT_EQ(result.status, IkStatus::NoSolution);
    EXPECT_EQ(result.message, "no solution: the search was stopped");
  }
  // The search of an unreachable goal with any number of attempts ends too.
  CollisionFreeIkOptions endless;
  endless.ik.max_attempts = std::numeric_limits<std::size_t>::max();
  endless.ik.max_solutions = std::size_t{1} << 63U;
  std::atomic<int> calls{0};
  const auto stopped =
      solveElbow(sceneWithBall({9.0, 0.0, 0.0}), {{3.0, 0.0, 0.0}}, endless, [&calls] { return ++calls > 50; });
  EXPECT_EQ(stopped[0].status, IkStatus::NoSolution);
}

TEST(CollisionFreeIk, EachWrongInputHasItsError)
{
  const auto scene = sceneWithBall({9.0, 0.0, 0.0});
  CpuChecker checker(scene);
  const int hand = scene->robot->linkIndex("hand");
  const auto fault = [&](const std::vector<KinematicConstraints>& goals, const std::vector<double>& state)
  { return errorOf([&] { solveCollisionFree(*scene, checker, "arm", goals, state, {}); }); };
  const KinematicConstraints good = positionGoal(hand, kHand);
  EXPECT_EQ(fault({good}, {0.0, 0.0}), "");
  EXPECT_EQ(fault({good}, {0.0}), "the state has 1 values; the robot has 2 variables");
  EXPECT_NE(fault({good}, {0.0, std::nan("")}).find("finite"), std::string::npos);
  EXPECT_EQ(fault({good, positionGoal(0, kHand)}, {0.0, 0.0}),
            "goal 1: group 'arm' has no joint that moves link 'foot'");
  EXPECT_EQ(fault({positionGoal(0, kHand)}, {0.0, 0.0}), "group 'arm' has no joint that moves link 'foot'");
  EXPECT_TRUE(solveCollisionFree(*scene, checker, "arm", {}, {0.0, 0.0}, {}).empty());
}
}  // namespace
}  // namespace gpu_planning_scene::core
