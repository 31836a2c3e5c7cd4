// Shortened paths are shorter and valid, and have the same ends.

#include <cmath>

#include <gtest/gtest.h>

#include <ompl/base/DiscreteMotionValidator.h>
#include <ompl/util/Exception.h>
#include <ompl/util/RandomNumbers.h>

#include "gpu_planning_scene/planning/path_shortcutter.h"
#include "planning/point_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;

TEST(PathShortcutter, FindsTheStraightLineInFreeSpace)
{
  const PointRobot robot({});
  PathGeometric path = robot.path({{-1.0, 0.0}, {-1.5, 1.5}, {0.0, -1.0}, {1.5, 1.5}, {1.0, 0.0}});
  EXPECT_TRUE(PathShortcutter(robot.information()).shorten(path, ob::plannerNonTerminatingCondition()));
  EXPECT_EQ(path.getStateCount(), 2U);
  EXPECT_NEAR(path.length(), 2.0, 1e-12);
}

TEST(PathShortcutter, ComesNearTheShortestPathRoundAWall)
{
  const PointRobot robot({{-0.1, -3.0, 0.1, 0.95}});
  PathGeometric path =
      robot.path({{-1.0, 0.0}, {-1.8, 0.7}, {-1.0, 1.3}, {0.0, 1.9}, {1.5, 1.5}, {1.9, 0.3}, {1.0, 0.0}});
  ASSERT_TRUE(robot.isValid(path));
  ShortcutterOptions options;
  options.candidates = 64;
  options.idle_rounds = 5;
  options.least_gain = 1e-3;
  EXPECT_TRUE(PathShortcutter(robot.information(), options).shorten(path, ob::plannerNonTerminatingCondition()));
  EXPECT_TRUE(robot.isValid(path));
  EXPECT_EQ(PointRobot::positionOf(path.getStates().front()), PointRobot::Position(-1.0, 0.0));
  EXPECT_EQ(PointRobot::positionOf(path.getStates().back()), PointRobot::Position(1.0, 0.0));
  // The shortest path of the cube's centre passes the corners (+-0.15, 1).
  const double shortest = 2.0 * std::hypot(0.85, 1.0) + 0.3;
  EXPECT_GE(path.length(), shortest);
  EXPECT_LE(path.length(), 1.05 * shortest);
}

class ShortenedPaths : public testing::TestWithParam<MotionRule>
{
};

TEST_P(ShortenedPaths, AreNeitherLongerNorInvalid)
{
  // With such large steps between samples, a part of a valid motion is often invalid.
  MotionCheckerOptions options;
  options.rule = GetParam();
  options.steps.prismatic = 0.5;
  const PointRobot robot(
      {{-0.6, -0.6, -0.2, -0.2}, {0.2, -0.6, 0.6, -0.2}, {-0.6, 0.2, -0.2, 0.6}, {0.2, 0.2, 0.6, 0.6}}, options);
  ompl::RNG random(3);
  for (int i = 0; i < 100; ++i)
  {
    std::vector<PointRobot::Position> positions = {{-1.0, -1.0}};
    while (positions.size() < 10)
    {
      const PointRobot::Position next(random.uniformReal(-1.5, 1.5), random.uniformReal(-1.5, 1.5));
      if (robot.isValid(robot.path({positions.back(), next})))
        positions.push_back(next);
    }
    PathGeometric path = robot.path(positions);
    const double length = path.length();
    const bool shorter = PathShortcutter(robot.information()).shorten(path, ob::plannerNonTerminatingCondition());
    EXPECT_EQ(shorter, path.length() < length);
    EXPECT_LE(path.length(), length);
    EXPECT_TRUE(robot.isValid(path)) << i;
    EXPECT_EQ(PointRobot::positionOf(path.getStates().front()), positions.front());
    EXPECT_EQ(PointRobot::positionOf(path.getStates().back()), positions.back());
  }
}

INSTANTIATE_TEST_SUITE_P(Rules, ShortenedPaths, testing::Values(MotionRule::Bound, MotionRule::Samples));

TEST(PathShortcutter, LeavesAPathAloneThatCannotBeShorter)
{
  const PointRobot robot({});
  PathShortcutter shortcutter(robot.information());
  for (const std::vector<PointRobot::Position>& positions :
       std::vector<std::vector<PointRobot::Position>>{{}, {{0.0, 0.0}}, {{0.0, 0.0}, {1.0, 0.0}}})
  {
    PathGeometric path = robot.path(positions);
    EXPECT_FALSE(shortcutter.shorten(path, ob::plannerNonTerminatingCondition()));
    EXPECT_EQ(path.getStateCount(), positions.size());
  }
}

TEST(PathShortcutter, MakesOneMotionOfSeveralThatAreAsLong)
{
  const PointRobot robot({{-0.1, -3.0, 0.1, 0.4}});
  using Positions = std::vector<PointRobot::Position>;
  const Positions over_the_wall = {{-1.0, 0.5}, {0.0, 0.5}, {1.0, 0.5}};
  const Positions ends = {{-1.0, 0.5}, {1.0, 0.5}};
  const Positions nowhere = {{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}};
  for (const auto& [positions, expected] :
       {std::pair(over_the_wall, ends), std::pair(nowhere, Positions{{0.5, 0.5}, {0.5, 0.5}})})
  {
    PathGeometric path = robot.path(positions);
    EXPECT_FALSE(PathShortcutter(robot.information()).shorten(path, ob::plannerNonTerminatingCondition()));
    Positions left;
    for (const ob::State* state : path.getStates())
      left.push_back(PointRobot::positionOf(state));
    EXPECT_EQ(left, expected);
  }
}

TEST(PathShortcutter, KeepsWhatIsAsLongAsAMotionThatIsNotValid)
{
  // A sample in the middle of the whole motion collides with the wall. The samples of its parts all miss the wall.
  MotionCheckerOptions options;
  options.rule = MotionRule::Samples;
  options.steps.prismatic = 1.0;
  const PointRobot robot({{-0.1, -3.0, 0.1, 0.4}}, options);
  PathGeometric path = robot.path({{-1.0, 0.0}, {-0.4, 0.0}, {0.4, 0.0}, {1.0, 0.0}});
  ASSERT_TRUE(robot.isValid(path));
  EXPECT_FALSE(PathShortcutter(robot.information()).shorten(path, ob::plannerNonTerminatingCondition()));
  EXPECT_EQ(path.getStateCount(), 4U);
}

TEST(PathShortcutter, DoesNothingIfThereIsNoTime)
{
  const PointRobot robot({});
  PathGeometric path = robot.path({{-1.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}});
  EXPECT_FALSE(PathShortcutter(robot.information()).shorten(path, ob::plannerAlwaysTerminatingCondition()));
  EXPECT_EQ(path.getStateCount(), 3U);
}

TEST(PathShortcutter, NeedsMotionsInBulk)
{
  const PointRobot robot({});
  robot.information()->setMotionValidator(std::make_shared<ob::DiscreteMotionValidator>(robot.information()));
  EXPECT_THROW(PathShortcutter(robot.information()), ompl::Exception);
}
}  // namespace
}  // namespace gpu_planning_scene::core
