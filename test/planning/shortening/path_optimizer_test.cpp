// Paths become shorter for as long as there is time, also by another way round an obstacle.

#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <ompl/base/DiscreteMotionValidator.h>
#include <ompl/base/PlannerData.h>
#include <ompl/util/Exception.h>
#include <ompl/util/RandomNumbers.h>

#include "base/seconds_since.h"
#include "gpu_planning_scene/planning/anytime_batch.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/path_optimizer.h"
#include "planning/point_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;

constexpr double kLongest = 60.0;  // much more time than needed

const PointRobot::Position kBegin{-1.0, 0.0};
const PointRobot::Position kEnd{1.0, 0.0};

/// A wall that can be passed at both ends. The lower end is nearer.
const std::vector<Wall> kWallWithTwoEnds = {{-0.1, -0.6, 0.1, 1.5}};
/// The shortest path of the cube's centre: it passes the corners (+-0.15, -0.65).
const double kShortest = 2.0 * std::hypot(0.85, 0.65) + 0.3;

/// Ends when the path has at most this length, or after kLongest.
class UntilShort
{
 public:
  explicit UntilShort(double length) : length_(length) {}

  ob::PlannerTerminationCondition condition()
  {
    return ob::PlannerTerminationCondition([this]
                                           { return lengths_.back() <= length_ || secondsSince(start_) > kLongest; });
  }
  void operator()(const PathGeometric& path) { lengths_.push_back(path.length()); }
  const std::vector<double>& lengths() const { return lengths_; }

 private:
  const double length_;
  std::vector<double> lengths_ = {std::numeric_limits<double>::infinity()};
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

class Optimizer : public testing::TestWithParam<MotionRule>
{
 protected:
  MotionCheckerOptions options() const
  {
    MotionCheckerOptions options;
    options.rule = GetParam();
    options.steps.prismatic = 0.02;
    return options;
  }
};

TEST_P(Optimizer, FindsTheShorterWayRoundAWall)
{
  const PointRobot robot(kWallWithTwoEnds, options());
  PathGeometric path = robot.path({kBegin, {-1.0, 1.8}, {1.0, 1.8}, kEnd});
  ASSERT_TRUE(robot.isValid(path));
  UntilShort until(1.01 * kShortest);
  PathOptimizer(robot.information(), robot.problem(kBegin, {kEnd})->getGoal())
      .improve(path, until.condition(), std::ref(until));
  EXPECT_LE(path.length(), 1.01 * kShortest);
  EXPECT_GE(path.length(), kShortest * (GetParam() == MotionRule::Bound ? 1.0 : 0.99));
  EXPECT_EQ(until.lengths().back(), path.length());
  for (std::size_t i = 1; i < until.lengths().size(); ++i)
    EXPECT_LE(until.lengths()[i], (1.0 + 1e-9) * until.lengths()[i - 1]);
  EXPECT_TRUE(robot.isValid(path));
  EXPECT_EQ(PointRobot::positionOf(path.getStates().front()), kBegin);
  EXPECT_EQ(PointRobot::positionOf(path.getStates().back()), kEnd);
}

INSTANTIATE_TEST_SUITE_P(Rules, Optimizer, testing::Values(MotionRule::Bound, MotionRule::Samples));

TEST(PathOptimizer, ChoosesTheNearestOfSeveralGoals)
{
  const PointRobot robot(kWallWithTwoEnds);
  const PointRobot::Position near{-1.0, 1.0};
  PathGeometric path = robot.path({kBegin, {-1.0, 1.8}, {1.0, 1.8}, kEnd});
  UntilShort until(1.0 + 1e-9);
  PathOptimizer(robot.information(), robot.problem(kBegin, {kEnd, near})->getGoal())
      .improve(path, until.condition(), std::ref(until));
  EXPECT_EQ(PointRobot::positionOf(path.getStates().back()), near);
  EXPECT_EQ(2U, path.getStateCount());
}

TEST(PathOptimizer, EndsAtTheStraightMotionToTheOnlyGoal)
{
  const PointRobot robot({});
  PathGeometric path = robot.path({kBegin, {0.0, 1.0}, kEnd});
  PathOptimizer(robot.information(), robot.problem(kBegin, {kEnd})->getGoal())
      .improve(path, ob::plannerNonTerminatingCondition());
  EXPECT_EQ(2U, path.getStateCount());
}

TEST(PathOptimizer, NeedsMotionsInBulk)
{
  const PointRobot robot({});
  const ob::GoalPtr goal = robot.problem(kBegin, {kEnd})->getGoal();
  robot.information()->setMotionValidator(std::make_shared<ob::DiscreteMotionValidator>(robot.information()));
  EXPECT_THROW(PathOptimizer(robot.information(), goal), ompl::Exception);
}

TEST(AnytimeBatch, ShortensItsFirstPathUntilTheTimeIsUp)
{
  const PointRobot robot(kWallWithTwoEnds);
  const ob::ProblemDefinitionPtr problem = robot.problem(kBegin, {kEnd});
  const auto planner = std::make_shared<AnytimeBatch>(robot.information());
  UntilShort until(1.01 * kShortest);
  problem->setIntermediateSolutionCallback(
      [&](const ob::Planner*, const std::vector<const ob::State*>& states, const ob::Cost cost)
      {
        PathGeometric path(robot.information());
        for (const ob::State* state : states)
          path.append(state);
        EXPECT_NEAR(cost.value(), path.length(), 1e-12);
        until(path);
      });
  planner->setProblemDefinition(problem);
  planner->setup();
  const auto best_cost = planner->getPlannerProgressProperties().at("best cost REAL");
  EXPECT_EQ("inf", best_cost());
  EXPECT_TRUE(planner->solve(until.condition()) == ob::PlannerStatus::EXACT_SOLUTION);
  auto& path = *problem->getSolutionPath()->as<PathGeometric>();
  EXPECT_TRUE(robot.isValid(path));
  EXPECT_LE(path.length(), 1.01 * kShortest);
  EXPECT_NEAR(std::stod(best_cost()), path.length(), 1e-5);

  const double length = path.length();
  EXPECT_TRUE(planner->Planner::solve(0.05) == ob::PlannerStatus::EXACT_SOLUTION) << "goes on";
  EXPECT_LE(problem->getSolutionPath()->length(), length);
  planner->clear();
  EXPECT_EQ("inf", best_cost());
}

TEST(AnytimeBatch, ForgetsThePathOfAnotherProblem)
{
  const PointRobot robot(kWallWithTwoEnds);
  AnytimeBatch planner(robot.information());
  for (const double y : {0.0, -1.0})
  {
    const ob::ProblemDefinitionPtr problem = robot.problem({-1.0, y}, {{1.0, y}});
    planner.setProblemDefinition(problem);
    planner.setup();
    ASSERT_TRUE(planner.Planner::solve(0.1) == ob::PlannerStatus::EXACT_SOLUTION);
    auto& path = *problem->getSolutionPath()->as<PathGeometric>();
    EXPECT_EQ(PointRobot::positionOf(path.getStates().front()), PointRobot::Position(-1.0, y));
    EXPECT_EQ(PointRobot::positionOf(path.getStates().back()), PointRobot::Position(1.0, y));
  }
}

TEST(AnytimeBatch, HasTheStatusOfItsSearchWithoutAPath)
{
  const PointRobot robot({{-0.1, -3.0, 0.1, 3.0}});
  AnytimeBatch planner(robot.information());
  planner.setProblemDefinition(robot.problem(kBegin, {kEnd}));
  planner.setup();
  EXPECT_TRUE(planner.Planner::solve(0.2) == ob::PlannerStatus::APPROXIMATE_SOLUTION);
}

TEST(BatchRrtConnect, DrawsStatesWithinItsLargestLength)
{
  const PointRobot robot({{-0.1, -3.0, 0.1, 3.0}});
  BatchRrtConnect planner(robot.information());
  planner.setProblemDefinition(robot.problem(kBegin, {kEnd}));
  planner.setup();
  planner.setMaxRounds(100);
  planner.setSearches(1);
  const double length = 2.4;
  planner.setLargestLength(length);
  planner.solve(ob::plannerNonTerminatingCondition());
  ob::PlannerData data(robot.information());
  planner.getPlannerData(data);
  ASSERT_GT(data.numVertices(), 100U);
  for (unsigned int i = 0; i < data.numVertices(); ++i)
  {
    const auto [x, y] = PointRobot::positionOf(data.getVertex(i).getState());
    EXPECT_LT(std::hypot(x + 1.0, y) + std::hypot(x - 1.0, y), length);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
