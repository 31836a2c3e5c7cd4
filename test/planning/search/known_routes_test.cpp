// Known paths are kept, lead to routes for other starts and goals, and never replace a check.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_planning_scene/planning/anytime_batch.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/known_paths.h"
#include "model/model_testing.h"
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

/// Waypoints of the point robot, by way of its corner.
KnownPaths::Path pathTo(double goal)
{
  return {{0.0, 0.0}, {2.0, 2.0}, {goal, 0.0}};
}

std::shared_ptr<GroupStateSpace> spaceOf(const std::shared_ptr<const RobotModel>& robot, const std::string& group)
{
  return std::make_shared<GroupStateSpace>(robot, group);
}

TEST(KnownPaths, AreThoseOfTheGroupWithTheNewestFirst)
{
  const PointRobot robot({});
  const auto plane = spaceOf(robot.scene()->robot, "plane");
  KnownPaths known(2);
  for (const double goal : {0.5, 1.0, 1.5})
    known.add(plane, pathTo(goal));
  ASSERT_EQ(known.of("plane").size(), 2u);
  EXPECT_EQ(*known.of("plane")[0], pathTo(1.5));
  EXPECT_EQ(*known.of("plane")[1], pathTo(1.0));
  EXPECT_TRUE(known.of("leg").empty());
}

TEST(KnownPaths, BetweenTheSameStatesReplaceEachOtherInBothDirections)
{
  const PointRobot robot({});
  const auto plane = spaceOf(robot.scene()->robot, "plane");
  KnownPaths known(4);
  known.add(plane, pathTo(1.0));
  known.add(plane, pathTo(0.5));
  const KnownPaths::Path back = {{1.0, 0.0002}, {0.7, 1.0}, {-0.0002, 0.0}};  // measured values
  known.add(plane, back);
  ASSERT_EQ(known.of("plane").size(), 2u);
  EXPECT_EQ(*known.of("plane")[0], back);
}

TEST(KnownPaths, OfAnglesThatDifferByTurnsAreTheSame)
{
  const auto robot = robotOf(
      "<link name='base'/>" + boxLink("wheel") + jointXml("turn", "continuous", "base", "wheel", "<axis xyz='0 0 1'/>"),
      R"(<group name="wheel"><joint name="turn"/></group>)");
  KnownPaths known(4);
  known.add(spaceOf(robot, "wheel"), {{1.0}, {2.0}, {3.0}});
  known.add(spaceOf(robot, "wheel"), {{3.0 - 2.0 * M_PI}, {-2.0}, {1.0 - 2.0 * M_PI}});
  EXPECT_EQ(known.of("wheel").size(), 1u);
}

TEST(KnownPaths, HaveTheVariablesOfTheirGroupOnly)
{
  const std::string limits = R"(<limit lower="-2" upper="2" effort="1" velocity="1"/>)";
  const auto robot = robotOf("<link name='base'/>" + boxLink("a") + boxLink("b") +
                                 jointXml("x", "prismatic", "base", "a", "<axis xyz='1 0 0'/>" + limits) +
                                 jointXml("y", "prismatic", "base", "b", "<axis xyz='0 1 0'/>" + limits),
                             R"(<group name="second"><joint name="y"/></group>)");
  KnownPaths known(4);
  known.add(spaceOf(robot, "second"), {{0.5, 0.0}, {0.5, 1.0}, {0.5, 0.7}});
  ASSERT_EQ(known.of("second").size(), 1u);
  EXPECT_EQ(*known.of("second")[0], (KnownPaths::Path{{0.0}, {1.0}, {0.7}}));
}

TEST(KnownPaths, AreNoStraightMotionsAndNoneIfTheCapacityIsZero)
{
  const PointRobot robot({});
  const auto plane = spaceOf(robot.scene()->robot, "plane");
  KnownPaths known(1);
  known.add(plane, {{0.0, 0.0}, {1.0, 0.0}});
  EXPECT_TRUE(known.of("plane").empty());
  KnownPaths none(0);
  none.add(plane, pathTo(1.0));
  EXPECT_TRUE(none.of("plane").empty());
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
      paths.push_back(robot_.path(positions));
    const ob::ScopedState<> from = robot_.at(start);
    const ob::ScopedState<> to = robot_.at(goal);
    std::vector<std::vector<Position>> found;
    for (PathGeometric& route : knownRoutes(robot_.information(), paths, {from.get()}, {to.get()}, kRange))
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

  const PointRobot robot_{{}};
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
  EXPECT_TRUE(routes({straight(0.0)}, {0.5, 0.0}, {0.5, 0.0}).empty()) << "the robot is there already";
}

TEST_F(KnownRoutes, AreNotLongerThanAPlanHasTimeFor)
{
  const ob::ScopedState<> from = robot_.at(kOver.front());
  const ob::ScopedState<> to = robot_.at(kOver.back());
  const auto with_range = [&](double range)
  { return knownRoutes(robot_.information(), {robot_.path(kOver)}, {from.get()}, {to.get()}, range); };
  EXPECT_EQ(with_range(0.01).size(), 1u);
  EXPECT_TRUE(with_range(1e-9).empty());
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

TEST(BatchRrtConnectWithKnownPaths, GrowsBothTreesAlongTheFreeEndsOfOneThatIsBlocked)
{
  const std::vector<Wall> walls = {{-0.1, -3.0, 0.1, 1.2}, {0.5, 1.4, 0.7, 3.0}};
  AtOnce blocked(walls);
  EXPECT_FALSE(blocked.solve(kOver));
  ob::PlannerData data(blocked.robot.information());
  blocked.planner.getPlannerData(data);
  std::array<int, 3> vertices{};  // by the tag: 1 for the start tree, 2 for the goal tree
  for (unsigned int i = 0; i < data.numVertices(); ++i)
    ++vertices.at(static_cast<std::size_t>(data.getVertex(i).getTag()));
  EXPECT_GT(vertices[1], 10);
  EXPECT_GT(vertices[2], 5);
  blocked.planner.setMaxRounds(0);
  ASSERT_TRUE(blocked.planner.Planner::solve(60.0) == ob::PlannerStatus::EXACT_SOLUTION);
  EXPECT_TRUE(blocked.robot.isValid(blocked.path()));
}

/// Half a millimetre is free on both sides of the robot. A search at random would take minutes.
const std::vector<Wall> kTightGap = {{-0.5, -3.0, 0.5, 0.9495}, {-0.5, 1.0505, 0.5, 3.0}};
const std::vector<Position> kThroughTheGap = {{-1.0, 0.0}, {-1.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}};

TEST(AnytimeBatchWithKnownPaths, BeginsWithOne)
{
  const PointRobot robot(kTightGap);
  AnytimeBatch planner(robot.information());
  const auto problem = robot.problem(kThroughTheGap.front(), {kThroughTheGap.back()});
  planner.setProblemDefinition(problem);
  planner.setKnownPaths({robot.path(kThroughTheGap)});
  planner.setup();
  ASSERT_TRUE(planner.Planner::solve(1.0) == ob::PlannerStatus::EXACT_SOLUTION);
  EXPECT_TRUE(robot.isValid(*problem->getSolutionPath()->as<PathGeometric>()));
}
}  // namespace
}  // namespace gpu_planning_scene::core
