// Known paths are kept, lead to routes for other starts and goals, and never replace a check.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/known_paths.h"
#include "planning/point_robot.h"
#include "planning/search/known_routes.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;
using Position = PointRobot::Position;

constexpr double kRange = 0.2;

/// A way over a wall.
const std::vector<Position> kOver = {{-1.0, 0.0}, {-1.0, 1.8}, {1.0, 1.8}, {1.0, 0.0}};

KnownPaths::Path pathTo(double goal)
{
  return {{0.0}, {goal}};
}

TEST(KnownPaths, AreThoseOfTheGroupWithTheNewestFirst)
{
  KnownPaths known(2);
  for (const double goal : {1.0, 2.0, 3.0})
    known.add("arm", pathTo(goal));
  known.add("hand", pathTo(4.0));
  ASSERT_EQ(known.of("arm").size(), 2u);
  EXPECT_EQ(*known.of("arm")[0], pathTo(3.0));
  EXPECT_EQ(*known.of("arm")[1], pathTo(2.0));
  ASSERT_EQ(known.of("hand").size(), 1u);
  EXPECT_TRUE(known.of("leg").empty());
}

TEST(KnownPaths, BetweenTheSameStatesReplaceEachOtherInBothDirections)
{
  KnownPaths known(4);
  known.add("arm", {{0.0}, {0.5}, {1.0}});
  known.add("arm", pathTo(2.0));
  known.add("arm", {{1.0}, {0.7}, {0.0}});
  ASSERT_EQ(known.of("arm").size(), 2u);
  EXPECT_EQ(*known.of("arm")[0], (KnownPaths::Path{{1.0}, {0.7}, {0.0}}));
}

TEST(KnownPaths, AreNotKeptIfTheCapacityIsZero)
{
  KnownPaths known(0);
  known.add("arm", pathTo(1.0));
  EXPECT_TRUE(known.of("arm").empty());
}

class KnownRoutes : public testing::Test
{
 protected:
  /// The positions of the routes from `start` to `goal` along known paths.
  std::vector<std::vector<Position>> routes(const std::vector<std::vector<Position>>& known, const Position& start,
                                            const Position& goal) const
  {
    std::vector<PathGeometric> paths;
    for (const std::vector<Position>& positions : known)
      paths.push_back(robot.path(positions));
    const ob::ScopedState<> from = robot.at(start);
    const ob::ScopedState<> to = robot.at(goal);
    std::vector<std::vector<Position>> found;
    for (PathGeometric& route : knownRoutes(robot.information(), paths, {from.get()}, {to.get()}, kRange))
    {
      found.emplace_back();
      for (const ob::State* state : route.getStates())
        found.back().push_back(PointRobot::positionOf(state));
    }
    return found;
  }

  static double distance(const Position& a, const Position& b)
  {
    return std::hypot(a.first - b.first, a.second - b.second);
  }

  /// The largest distance of the expected positions from the states of a route.
  static double farthest(const std::vector<Position>& expected, const std::vector<Position>& route)
  {
    double largest = 0.0;
    for (const Position& position : expected)
    {
      double least = 1e9;
      for (const Position& state : route)
        least = std::min(least, distance(position, state));
      largest = std::max(largest, least);
    }
    return largest;
  }

  const PointRobot robot{{}};
};

TEST_F(KnownRoutes, LeadFromTheStartToTheGoalInMotionsWithinTheRange)
{
  const Position left{-1.1, 0.3};
  const Position right{1.05, 0.5};
  for (const bool is_forward : {true, false})
  {
    const Position& start = is_forward ? left : right;
    const Position& goal = is_forward ? right : left;
    const auto found = routes({kOver}, start, goal);
    ASSERT_EQ(found.size(), 1u);
    const std::vector<Position>& route = found[0];
    EXPECT_EQ(route.front(), start);
    EXPECT_EQ(route.back(), goal);
    double length = 0.0;
    for (std::size_t i = 1; i < route.size(); ++i)
    {
      EXPECT_LE(distance(route[i - 1], route[i]), kRange + 1e-12);
      length += distance(route[i - 1], route[i]);
    }
    EXPECT_LT(farthest({{-1.0, 1.8}, {0.0, 1.8}, {1.0, 1.8}}, route), 1e-12);
    EXPECT_LT(length, 5.1);  // the path has 5.6, and its ends are left out
  }
}

TEST_F(KnownRoutes, LeadAlongAPartOfOneMotion)
{
  const auto found = routes({{{-1.0, 0.0}, {1.0, 0.0}}}, {0.6, 0.1}, {-0.6, 0.1});
  ASSERT_EQ(found.size(), 1u);
  for (const Position& position : found[0])
    EXPECT_LE(std::abs(position.first), 0.6 + 1e-12);
  EXPECT_LT(farthest({{0.0, 0.0}}, found[0]), kRange);
}

TEST_F(KnownRoutes, AreTheTwoNearestPathsAndNoneThatIsFarAway)
{
  const auto straight = [](double y) { return std::vector<Position>{{-1.0, y}, {1.0, y}}; };
  const auto found = routes({straight(0.4), straight(-0.1), straight(0.3), straight(1.5)}, {-1.0, 0.0}, {1.0, 0.0});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_LT(farthest({{0.0, -0.1}}, found[0]), 1e-12);
  EXPECT_LT(farthest({{0.0, 0.3}}, found[1]), 1e-12);
  EXPECT_TRUE(routes({straight(1.5)}, {-1.0, 0.0}, {1.0, 0.0}).empty());
}

/// A problem that is to be solved by a known path at once, or not at all.
struct AtOnce
{
  AtOnce(const std::vector<Wall>& walls, const MotionCheckerOptions& options = {})
    : robot(walls, options), problem(robot.problem(kOver.front(), {kOver.back()})), planner(robot.information())
  {
    planner.setSearches(1);
    planner.setMaxRounds(1);
    planner.setExactOnly(true);
    planner.setProblemDefinition(problem);
    planner.setup();
  }

  bool solve(const std::vector<Position>& known)
  {
    planner.setKnownPaths({robot.path(known)});
    return planner.Planner::solve(60.0) == ob::PlannerStatus::EXACT_SOLUTION;
  }
  PathGeometric& path() const { return *problem->getSolutionPath()->as<PathGeometric>(); }

  PointRobot robot;
  ob::ProblemDefinitionPtr problem;
  BatchRrtConnect planner;
};

const std::vector<Wall> kWallBelow = {{-0.1, -3.0, 0.1, 1.5}};

TEST(BatchRrtConnectWithKnownPaths, SolvesTheirProblemAtOnce)
{
  AtOnce without(kWallBelow);
  EXPECT_FALSE(without.solve({}));
  AtOnce with(kWallBelow);
  ASSERT_TRUE(with.solve(kOver));
  EXPECT_TRUE(with.robot.isValid(with.path()));
}

TEST(BatchRrtConnectWithKnownPaths, NeverFollowsOneThroughAnObstacle)
{
  EXPECT_FALSE(AtOnce({{-0.1, -3.0, 0.1, 3.0}}).solve(kOver));
  // Samples half a metre apart do not see a wall of a millimetre.
  MotionCheckerOptions coarse;
  coarse.steps = {0.5, 0.5};
  EXPECT_FALSE(AtOnce({{0.3, -3.0, 0.301, 3.0}}, coarse).solve(kOver));
}

TEST(BatchRrtConnectWithKnownPaths, GoesRoundAnObstacleOnOneOfThem)
{
  for (int run = 0; run < 10; ++run)
  {
    AtOnce planning({{-0.1, -3.0, 0.1, 1.2}, {0.5, 1.4, 0.7, 3.0}});
    planning.planner.setMaxRounds(0);
    ASSERT_TRUE(planning.solve(kOver));
    EXPECT_TRUE(planning.robot.isValid(planning.path()));
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
