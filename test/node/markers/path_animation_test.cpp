// The states of an animated path.

#include <cmath>

#include <gtest/gtest.h>

#include "model/model_testing.h"
#include "node/markers/path_animation.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A robot with the joints `slide` (prismatic, -1 to 2 m) and `spin` (continuous).
std::shared_ptr<const RobotModel> spinningRobot()
{
  return robotOf(boxLink("base") + boxLink("cart") + boxLink("rotor") +
                 jointXml("slide", "prismatic", "base", "cart", kLimits) +
                 jointXml("spin", "continuous", "cart", "rotor", "<axis xyz=\"0 0 1\"/>"));
}

double positionAt(const AnimatedPath& path, double seconds)
{
  return animatedState(*spinningRobot(), path, seconds)[0];
}

double angleAt(const AnimatedPath& path, double seconds)
{
  return animatedState(*spinningRobot(), path, seconds)[1];
}

TEST(PathAnimation, APathWithoutTimesHasAConstantSpeedAndLastsFourSeconds)
{
  const AnimatedPath path = pathAtConstantSpeed(*spinningRobot(), {{0.0, 0.0}, {1.5, 0.0}, {2.0, 0.0}});
  ASSERT_EQ(3u, path.seconds.size());
  EXPECT_NEAR(0.0, positionAt(path, 0.0), 1e-9);
  EXPECT_NEAR(0.5, positionAt(path, 1.0), 1e-3);
  EXPECT_NEAR(1.0, positionAt(path, 2.0), 1e-3) << "half of the length, not half of the waypoints";
  EXPECT_NEAR(1.75, positionAt(path, 3.5), 1e-3);
  EXPECT_EQ(2.0, positionAt(path, 4.0));
}

TEST(PathAnimation, TheMotionPausesAtItsEndAndRepeats)
{
  const AnimatedPath path = pathAtConstantSpeed(*spinningRobot(), {{0.0, 0.0}, {2.0, 0.0}});
  EXPECT_EQ(2.0, positionAt(path, 4.01));
  EXPECT_EQ(2.0, positionAt(path, 4.99));
  EXPECT_NEAR(0.005, positionAt(path, 5.01), 1e-3);
  EXPECT_NEAR(1.0, positionAt(path, 5.0 * 1000.0 + 2.0), 1e-3);
  EXPECT_EQ(2.0, positionAt(path, 5.0 * 1000.0 + 4.5));
  EXPECT_EQ(0.0, positionAt(path, -1.0)) << "it has not begun";
}

TEST(PathAnimation, ATimedPathKeepsItsTimes)
{
  TimedPath timed;
  for (const auto& [seconds, position] : {std::pair(0.0, 0.0), std::pair(0.5, 1.0), std::pair(2.5, 2.0)})
  {
    timed.points.emplace_back().seconds = seconds;
    timed.points.back().positions = {position, 0.0};
  }
  const AnimatedPath path = pathAtItsTimes(timed);
  EXPECT_NEAR(0.5, positionAt(path, 0.25), 1e-9);
  EXPECT_NEAR(1.0, positionAt(path, 0.5), 1e-9);
  EXPECT_NEAR(1.5, positionAt(path, 1.5), 1e-9);
  EXPECT_EQ(2.0, positionAt(path, 3.4)) << "it pauses";
  EXPECT_NEAR(0.2, positionAt(path, 3.6), 1e-9) << "it repeats";
}

TEST(PathAnimation, AContinuousJointTurnsInTheShorterDirection)
{
  const AnimatedPath path = pathAtConstantSpeed(*spinningRobot(), {{0.0, 3.0}, {0.0, -3.0}});
  for (const double seconds : {0.0, 1.0, 2.0, 3.0, 4.0})
    EXPECT_LT(std::cos(angleAt(path, seconds)), std::cos(2.99)) << seconds << " s: it does not turn through 0";
}

TEST(PathAnimation, AHalfTurnOfAContinuousJointDoesNotJump)
{
  const double half = std::acos(-1.0);
  for (const double end : {half, -half})
  {
    const AnimatedPath path = pathAtConstantSpeed(*spinningRobot(), {{0.0, 0.0}, {0.0, end}});
    const double sign = angleAt(path, 2.0) > 0.0 ? 1.0 : -1.0;
    for (int i = 0; i <= 40; ++i)
    {
      const double expected = sign * half * i / 40.0;
      EXPECT_NEAR(1.0, std::cos(angleAt(path, 0.1 * i) - expected), 1e-6) << i;
    }
  }
}

TEST(PathAnimation, ARobotThatDoesNotMoveStandsStill)
{
  for (const AnimatedPath& path : {pathAtConstantSpeed(*spinningRobot(), {{1.0, 0.5}}),
                                   pathAtConstantSpeed(*spinningRobot(), {{1.0, 0.5}, {1.0, 0.5}})})
    for (const double seconds : {0.0, 0.5, 1.0, 4.0, 7.3})
    {
      EXPECT_EQ(1.0, positionAt(path, seconds));
      EXPECT_EQ(0.5, angleAt(path, seconds));
    }
}
}  // namespace
}  // namespace gpu_planning_scene::core
