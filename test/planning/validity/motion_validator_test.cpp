// The motion validator fulfils OMPL's contract, and OMPL's own planners find valid paths with it. The test of many
// threads is in test/concurrency.

#include <limits>

#include <gtest/gtest.h>

#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include "gpu_planning_scene/planning/path_length_objective.h"
#include "planning/point_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
namespace og = ompl::geometric;
using Position = PointRobot::Position;

/// Two walls, each with a gap at a different end. The robot is 0.1 m wide.
const std::vector<Wall> kWallsWithGaps = {{-0.5, -3.0, -0.3, 1.7}, {0.3, -1.7, 0.5, 3.0}};

struct MotionValidatorTest : testing::Test
{
  bool check(const Position& from, const Position& to)
  {
    return robot.validator().checkMotion(robot.at(from).get(), robot.at(to).get());
  }

  PointRobot robot{kWallsWithGaps};
};

TEST_F(MotionValidatorTest, CountsValidAndInvalidMotions)
{
  EXPECT_TRUE(check({-1.0, 0.0}, {-1.0, 1.0}));
  EXPECT_FALSE(check({-1.0, 0.0}, {1.0, 0.0}));
  EXPECT_FALSE(check({-0.4, 0.0}, {-1.0, 0.0})) << "the start collides";
  EXPECT_FALSE(check({-1.0, 0.0}, {-2.5, 0.0})) << "out of bounds";
  EXPECT_EQ(robot.validator().getValidMotionCount(), 1u);
  EXPECT_EQ(robot.validator().getInvalidMotionCount(), 3u);
}

/// OMPL's bounds accept NaN, because every comparison with it is false.
TEST_F(MotionValidatorTest, FindsNoMotionValidThatHasNoNumbers)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(check({-1.0, nan}, {-1.0, 0.0}));
  EXPECT_FALSE(check({-1.0, 0.0}, {nan, 0.0}));
  EXPECT_FALSE(robot.information()->isValid(robot.at({nan, 0.0}).get()));
  auto storage = robot.at({1.5, 1.5});
  std::pair<ob::State*, double> last_valid{storage.get(), 7.0};
  EXPECT_FALSE(robot.validator().checkMotion(robot.at({-1.0, 0.0}).get(), robot.at({nan, 0.0}).get(), last_valid));
  EXPECT_EQ(last_valid.second, 0.0);
}

TEST_F(MotionValidatorTest, FindsNoMotionValidThatIsNotDecidedInTime)
{
  const auto from = robot.at({-1.0, 0.0});
  const auto to = robot.at({-1.0, 1.0});
  const auto never = ob::plannerAlwaysTerminatingCondition();
  EXPECT_EQ(robot.validator().validateMotions({{from.get(), to.get()}}, never), std::vector<std::uint8_t>{0});
  EXPECT_EQ(robot.validator().validateCoarsely({{from.get(), to.get()}}, never), std::vector<std::uint8_t>{0});
  EXPECT_EQ(robot.validator().validateExtensions({{from.get(), to.get()}}, never), std::vector<std::uint8_t>{0});
  EXPECT_FALSE(robot.validator().validatePath(robot.path({{-1.0, 0.0}, {-1.0, 1.0}}), never));
  EXPECT_EQ(robot.validator().statesChecked(), 0u);
}

TEST_F(MotionValidatorTest, ChecksAMotionAgainUnlessItRemembersValidOnes)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  auto validator = std::make_shared<MotionValidator>(robot.information(), robot.scene(), robot.checker());
  const auto states_for = [&](const Position& from, const Position& to, std::uint8_t expected)
  {
    const auto a = robot.at(from);
    const auto b = robot.at(to);
    const std::uint64_t before = validator->statesChecked();
    EXPECT_EQ(validator->validateMotions({{a.get(), b.get()}}), std::vector<std::uint8_t>{expected});
    return validator->statesChecked() - before;
  };
  EXPECT_GT(states_for({-1.0, 0.0}, {-1.0, 1.0}, 1), 0U);
  EXPECT_GT(states_for({-1.0, 0.0}, {-1.0, 1.0}, 1), 0U);
  validator->rememberValidMotions();
  EXPECT_GT(states_for({-1.0, 0.0}, {-1.0, 1.0}, 1), 0U);
  EXPECT_EQ(states_for({-1.0, 0.0}, {-1.0, 1.0}, 1), 0U);
  EXPECT_TRUE(validator->validatePath(robot.path({{-1.0, 0.0}, {-1.0, 1.0}})));
  EXPECT_GT(states_for({-1.0, 1.0}, {-1.0, 0.0}, 1), 0U) << "the way back is another motion";
  EXPECT_GT(states_for({-1.0, 0.0}, {1.0, 0.0}, 0), 0U);
  EXPECT_GT(states_for({-1.0, 0.0}, {1.0, 0.0}, 0), 0U) << "invalid motions are not remembered";
  states_for({-1.0, 0.0}, {-1.0, nan}, 0);
  states_for({nan, 0.0}, {-1.0, 1.0}, 0);
}

/// The robot collides with the first wall from x = -0.55 to -0.25.
TEST_F(MotionValidatorTest, ChecksExtensionsOfTreesWithoutTheirStarts)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto valid = [&](const Position& from, const Position& to) {
    return robot.validator().validateExtensions({{robot.at(from).get(), robot.at(to).get()}}).front() != 0;
  };
  EXPECT_TRUE(valid({-0.28, 0.0}, {-0.22, 0.0})) << "the start collides, and the only other sample is free";
  EXPECT_FALSE(valid({-0.28, 0.0}, {-0.26, 0.0})) << "the end collides";
  const std::uint64_t before = robot.validator().statesChecked();
  EXPECT_FALSE(valid({0.0, 0.0}, {0.0, -2.5})) << "the end is out of bounds";
  EXPECT_FALSE(valid({0.0, 0.0}, {0.0, nan}));
  EXPECT_FALSE(valid({0.0, nan}, {0.0, 0.0}));
  EXPECT_EQ(before, robot.validator().statesChecked());
}

TEST_F(MotionValidatorTest, ChecksCoarselyAtFourTimesTheSteps)
{
  MotionCheckerOptions options;
  options.steps.prismatic = 0.1;
  const PointRobot other({{-0.52, -3.0, -0.48, 3.0}}, options);
  const MotionValidator& validator = other.validator();
  const auto from = other.at({-0.8, 0.0});
  const auto to = other.at({0.0, 0.0});
  EXPECT_EQ(validator.validateMotions({{from.get(), to.get()}}), std::vector<std::uint8_t>{0});
  const std::uint64_t before = validator.statesChecked();
  EXPECT_EQ(validator.validateCoarsely({{from.get(), to.get()}}), std::vector<std::uint8_t>{1})
      << "-0.8, -0.4 and 0 are beside the wall";
  EXPECT_EQ(3U, validator.statesChecked() - before);
}

TEST_F(MotionValidatorTest, GivesTheLastValidStateOfAnInvalidMotionAlone)
{
  const auto from = robot.at({-1.0, 0.0});
  const auto beyond = robot.at({1.0, 0.0});
  auto storage = robot.at({1.5, 1.5});
  std::pair<ob::State*, double> last_valid{storage.get(), 7.0};
  EXPECT_TRUE(robot.validator().checkMotion(from.get(), robot.at({-1.0, 1.0}).get(), last_valid));
  EXPECT_EQ(last_valid.second, 7.0);
  EXPECT_EQ(PointRobot::positionOf(storage.get()), Position(1.5, 1.5));

  EXPECT_FALSE(robot.validator().checkMotion(from.get(), beyond.get(), last_valid));
  // The wall begins at -0.5, and half the robot's width is 0.05.
  EXPECT_LT(PointRobot::positionOf(storage.get()).first, -0.55);
  EXPECT_GT(PointRobot::positionOf(storage.get()).first, -0.6);
  EXPECT_NEAR(last_valid.second, (PointRobot::positionOf(storage.get()).first + 1.0) / 2.0, 1e-12);
  EXPECT_TRUE(robot.validator().checkMotion(from.get(), storage.get()));

  std::pair<ob::State*, double> without_state{nullptr, 7.0};
  EXPECT_FALSE(robot.validator().checkMotion(from.get(), beyond.get(), without_state));
  EXPECT_EQ(without_state.second, last_valid.second);

  const auto inside = robot.at({-0.4, 0.0});
  EXPECT_FALSE(robot.validator().checkMotion(inside.get(), beyond.get(), last_valid));
  EXPECT_EQ(last_valid.second, 0.0);
  EXPECT_EQ(PointRobot::positionOf(storage.get()), Position(-0.4, 0.0));
}

TEST_F(MotionValidatorTest, MayWriteTheLastValidStateOverTheEnd)
{
  const auto from = robot.at({-1.0, 0.0});
  auto to = robot.at({1.0, 0.0});
  std::pair<ob::State*, double> last_valid{to.get(), 0.0};
  EXPECT_FALSE(robot.validator().checkMotion(from.get(), to.get(), last_valid));
  EXPECT_LT(PointRobot::positionOf(to.get()).first, -0.55);
  EXPECT_GT(PointRobot::positionOf(to.get()).first, -0.6);
}

TEST_F(MotionValidatorTest, AnswersInBulkAsOneByOne)
{
  const auto start = robot.at({-1.0, 0.0});
  std::vector<ob::ScopedState<>> ends;
  std::vector<MotionValidator::Motion> motions;
  for (int i = 0; i < 40; ++i)
    ends.push_back(robot.at({-1.9 + 0.095 * i, 1.9 - 0.07 * i}));
  for (const auto& end : ends)
    motions.emplace_back(start.get(), end.get());
  const std::vector<std::uint8_t> bulk = robot.validator().validateMotions(motions);
  ASSERT_EQ(bulk.size(), motions.size());
  int valid = 0;
  for (std::size_t i = 0; i < motions.size(); ++i)
  {
    EXPECT_EQ(bulk[i] != 0, robot.validator().checkMotion(motions[i].first, motions[i].second)) << i;
    valid += bulk[i];
  }
  EXPECT_GT(valid, 5);
  EXPECT_LT(valid, 35);
  EXPECT_TRUE(robot.validator().validateMotions({}).empty());
}

TEST_F(MotionValidatorTest, ValidatesPathsOfAnyLength)
{
  EXPECT_TRUE(robot.validator().validatePath(robot.path({{-1.0, 0.0}, {-1.0, 1.0}, {-1.5, 1.5}})));
  EXPECT_FALSE(robot.validator().validatePath(robot.path({{-1.0, 0.0}, {-1.0, 1.0}, {1.0, 0.0}})));
  EXPECT_TRUE(robot.validator().validatePath(robot.path({{-1.0, 0.0}})));
  EXPECT_FALSE(robot.validator().validatePath(robot.path({{-0.4, 0.0}})));
  EXPECT_FALSE(robot.validator().validatePath(robot.path({})));
}

template <class Planner>
class OmplPlanners : public testing::Test
{
};
using Planners = testing::Types<og::RRTConnect, og::PRM, og::BITstar, og::LBKPIECE1>;
TYPED_TEST_SUITE(OmplPlanners, Planners);

TYPED_TEST(OmplPlanners, FindAValidPath)
{
  const PointRobot robot(kWallsWithGaps);
  const ob::ProblemDefinitionPtr problem = robot.problem({-1.0, 0.0}, {{1.0, 0.0}});
  const auto objective = std::make_shared<PathLengthObjective>(robot.information());
  objective->setCostThreshold(objective->infiniteCost());  // stop at the first path
  problem->setOptimizationObjective(objective);
  TypeParam planner(robot.information());
  planner.setProblemDefinition(problem);
  planner.setup();
  EXPECT_EQ(planner.solve(ob::timedPlannerTerminationCondition(60.0)), ob::PlannerStatus::EXACT_SOLUTION);
  ASSERT_TRUE(problem->hasExactSolution());
  EXPECT_TRUE(robot.isValid(*problem->getSolutionPath()->as<og::PathGeometric>()));
}
}  // namespace
}  // namespace gpu_planning_scene::core
