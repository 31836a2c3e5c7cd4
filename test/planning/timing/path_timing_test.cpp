// Times of paths: limits, deviations and blends, with an independent interpolation of the points as a controller does
// it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/planning/path_timing.h"
#include "model/model_testing.h"
#include "model/real_robots.h"
#include "planning/point_robot.h"
#include "support/repetitions.h"

namespace gpu_planning_scene::core
{
namespace
{
using Rows = std::vector<std::vector<double>>;

Eigen::ArrayXd arrayOf(const std::vector<double>& row)
{
  return Eigen::Map<const Eigen::ArrayXd>(row.data(), static_cast<Eigen::Index>(row.size()));
}

struct Moment
{
  Eigen::ArrayXd position;
  Eigen::ArrayXd velocity;
};

/// The polynomial of least degree in time that has the values and derivatives of both points, as ros_control's
/// joint_trajectory_controller interpolates: cubic, or quintic with the accelerations.
Moment interpolated(const TimedPoint& from, const TimedPoint& to, double time, bool quintic)
{
  const Eigen::Index count = quintic ? 3 : 2;
  const double length = to.seconds - from.seconds;
  // Row i: the coefficients of the i-th derivative by time / length, at the beginning and at the end.
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(2 * count, 2 * count);
  const auto width = static_cast<Eigen::Index>(from.positions.size());
  Eigen::MatrixXd values(2 * count, width);
  for (int derivative = 0; derivative < count; ++derivative)
    for (int power = derivative; power < 2 * count; ++power)
    {
      double factor = 1.0;
      for (int i = 0; i < derivative; ++i)
        factor *= power - i;
      equations(derivative, power) = power == derivative ? factor : 0.0;
      equations(count + derivative, power) = factor;
    }
  const auto set = [&](Eigen::Index row, const TimedPoint& point)
  {
    values.row(row) = arrayOf(point.positions).matrix().transpose();
    values.row(row + 1) = length * arrayOf(point.velocities).matrix().transpose();
    if (quintic)
      values.row(row + 2) = length * length * arrayOf(point.accelerations).matrix().transpose();
  };
  set(0, from);
  set(count, to);
  const Eigen::MatrixXd coefficients = equations.fullPivLu().solve(values);
  Eigen::RowVectorXd position = Eigen::RowVectorXd::Zero(width);
  Eigen::RowVectorXd velocity = Eigen::RowVectorXd::Zero(width);
  const double fraction = time / length;
  for (int power = 2 * count - 1; power >= 0; --power)
  {
    velocity = velocity * fraction + position;
    position = position * fraction + coefficients.row(power);
  }
  return {position.transpose().array(), velocity.transpose().array() / length};
}

/// A controller's moments, one for each millisecond.
std::vector<Moment> everyMillisecond(const std::vector<TimedPoint>& points)
{
  std::vector<Moment> moments;
  std::size_t next = 1;
  for (int i = 0; points.size() > 1 && 1e-3 * i <= points.back().seconds; ++i)
  {
    while (points[next].seconds < 1e-3 * i)
      ++next;
    moments.push_back(interpolated(points[next - 1], points[next], 1e-3 * i - points[next - 1].seconds, false));
  }
  return moments;
}

/// The least deviation of a position from the path: the largest difference of a variable, at the best point of the
/// path.
double deviationFrom(const Rows& path, const Eigen::ArrayXd& position)
{
  double least = (position - arrayOf(path.front())).abs().maxCoeff();
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
  {
    const Eigen::ArrayXd from = arrayOf(path[i]);
    const Eigen::ArrayXd to = arrayOf(path[i + 1]);
    const auto at = [&](double fraction) { return (position - (from + fraction * (to - from))).abs().maxCoeff(); };
    double lower = 0.0;
    double upper = 1.0;
    for (int step = 0; step < 60; ++step)  // the deviation is convex along the segment
    {
      const double third = (upper - lower) / 3.0;
      (at(lower + third) < at(upper - third) ? upper : lower) +=
          (at(lower + third) < at(upper - third) ? -third : third);
    }
    least = std::min(least, at(lower));
  }
  return least;
}

Eigen::ArrayXd limitsOf(const RobotModel& robot, std::optional<double> Variable::*limit, double factor)
{
  Eigen::ArrayXd limits(static_cast<Eigen::Index>(robot.variables().size()));
  for (std::size_t i = 0; i < robot.variables().size(); ++i)
    limits[static_cast<Eigen::Index>(i)] = factor * (robot.variables()[i].*limit).value_or(1.0);
  return limits;
}

/// Expects what timePath promises for every path. `path`: values that continue without whole turns.
void expectPromises(const RobotModel& robot, const TimedPath& timed, const Rows& path, const PathTimingOptions& options)
{
  constexpr double kRounding = 1e-6;
  ASSERT_GE(timed.points.size(), 2U);
  EXPECT_EQ(timed.points.front().seconds, 0.0);
  EXPECT_EQ(timed.points.front().positions, path.front());
  EXPECT_EQ(timed.points.back().positions, path.back());
  for (const TimedPoint* end : {&timed.points.front(), &timed.points.back()})
    EXPECT_EQ(arrayOf(end->velocities).abs().maxCoeff(), 0.0);
  const Eigen::ArrayXd velocity = limitsOf(robot, &Variable::max_velocity, options.max_velocity_scaling_factor);
  const Eigen::ArrayXd acceleration =
      limitsOf(robot, &Variable::max_acceleration, options.max_acceleration_scaling_factor);
  for (std::size_t i = 0; i + 1 < timed.points.size(); ++i)
  {
    const TimedPoint& from = timed.points[i];
    const TimedPoint& to = timed.points[i + 1];
    ASSERT_GE(to.seconds - from.seconds, 0.99e-5);
    ASSERT_LE(to.seconds - from.seconds, 0.1 + kRounding);
    for (const double part : {0.1, 0.3, 0.5, 0.6, 0.9})
    {
      const double time = part * (to.seconds - from.seconds);
      const Eigen::ArrayXd curve =
          arrayOf(from.positions) + time * arrayOf(from.velocities) + 0.5 * time * time * arrayOf(from.accelerations);
      for (const bool quintic : {false, true})
        ASSERT_LT((interpolated(from, to, time, quintic).position - curve).abs().maxCoeff(), 1e-4) << quintic;
    }
  }
  const std::vector<Moment> moments = everyMillisecond(timed.points);
  for (std::size_t i = 0; i < moments.size(); ++i)
  {
    ASSERT_TRUE((moments[i].velocity.abs() <= velocity + kRounding).all()) << i << " ms";
    ASSERT_LE(deviationFrom(path, moments[i].position), options.max_deviation + kRounding) << i << " ms";
    if (i == 0)
      continue;
    const Eigen::ArrayXd change = (moments[i].velocity - moments[i - 1].velocity) / 1e-3;
    ASSERT_TRUE((change.abs() <= acceleration * (1.0 + 1e-3) + kRounding).all()) << i << " ms: " << change.transpose();
    const Eigen::ArrayXd slope = (moments[i].position - moments[i - 1].position) / 1e-3;
    ASSERT_TRUE((slope.abs() <= velocity + kRounding).all()) << i << " ms";
  }
}

/// The number of colliding moments at which the curve is beside the path.
std::ptrdiff_t collisionsBeside(StateChecker& checker, const std::string& group, const TimedPath& timed,
                                const Rows& path)
{
  std::vector<double> beside;
  std::size_t count = 0;
  for (const Moment& moment : everyMillisecond(timed.points))
    if (deviationFrom(path, moment.position) > 1e-6)
    {
      beside.insert(beside.end(), moment.position.data(), moment.position.data() + moment.position.size());
      ++count;
    }
  const std::vector<std::uint8_t> valid = checker.check(beside.data(), count, group).valid;
  return std::count(valid.begin(), valid.end(), 0);
}

/// The cube of PointRobot, whose URDF limits its speed to 1 m/s. Its acceleration is not limited, so it is 1 m/s^2.
TimedPath timesOf(const PointRobot& robot, const Rows& path, const PathTimingOptions& options = {})
{
  return timePath(*robot.scene(), robot.checker(), "plane", path, options);
}

/// A base, a turntable without limits and an arm. `joint_limits`: as in MoveIt's file.
std::shared_ptr<const RobotModel> mobileRobot(const std::vector<JointLimits>& limits,
                                              const std::string& type = "planar", const std::string& property = "")
{
  RobotModelOptions options;
  options.joint_limits = limits;
  return RobotModel::fromXml(
      "<robot name='test'><link name='base'/>" + boxLink("table") + "<link name='arm'/>" +
          jointXml("turn", "continuous", "base", "table", "<axis xyz='0 0 1'/><limit effort='1' velocity='2'/>") +
          jointXml("lift", "prismatic", "table", "arm", "<limit lower='0' upper='1' effort='1' velocity='0'/>") +
          "</robot>",
      "<robot name='test'><virtual_joint name='world' type='" + type +
          "' parent_frame='map' child_link='base'/><group name='all'><joint name='world'/><joint name='turn'/>"
          "<joint name='lift'/></group><group name='table'><joint name='turn'/></group>" +
          property + "</robot>",
      options);
}

TEST(PathTiming, OfAStraightMotionIsATrapezoid)
{
  const PointRobot robot({});
  const Rows path = {{-1.0, -0.5}, {1.0, 0.5}};
  for (const auto& [velocity, acceleration, seconds] :
       std::vector<std::array<double, 3>>{{1.0, 1.0, 3.0}, {0.5, 1.0, 4.5}, {1.0, 0.5, 4.0}, {1.0, 0.02, 20.0}})
  {
    PathTimingOptions options;
    options.max_velocity_scaling_factor = velocity;
    options.max_acceleration_scaling_factor = acceleration;
    const TimedPath timed = timesOf(robot, path, options);
    EXPECT_NEAR(timed.points.back().seconds, seconds, 1e-9);
    expectPromises(*robot.scene()->robot, timed, path, options);
    EXPECT_EQ(timed.blends + timed.stops, 0U);
  }
}

TEST(PathTiming, SlowsDownAtACornerWithoutAStop)
{
  const PointRobot robot({});
  const Rows path = {{-1.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}};
  double last = 0.0;
  for (const double deviation : {0.5, 0.05, 0.001, 0.0})
  {
    PathTimingOptions options;
    options.max_deviation = deviation;
    const TimedPath timed = timesOf(robot, path, options);
    expectPromises(*robot.scene()->robot, timed, path, options);
    EXPECT_EQ(timed.blends, deviation > 0.0 ? 1U : 0U);
    EXPECT_EQ(timed.stops, deviation > 0.0 ? 0U : 1U);
    EXPECT_GT(timed.points.back().seconds, last + 1e-3);
    last = timed.points.back().seconds;
  }
  EXPECT_NEAR(last, 4.0, 1e-9) << "with a stop";
}

TEST(PathTiming, DoesNotSlowDownWhereThePathGoesStraightOn)
{
  const PointRobot robot({});
  const TimedPath timed =
      timesOf(robot, {{-1.0, -0.3}, {-0.9, -0.27}, {-0.7, -0.21}, {-0.3, -0.09}, {0.0, 0.0}, {1.0, 0.3}});
  EXPECT_NEAR(timed.points.back().seconds, 3.0, 1e-6);
  EXPECT_EQ(timed.blends + timed.stops, 0U);
}

/// The cube passes the corner of a wall at a small distance. A blend of 0.05 m, or of a quarter of it, would touch it.
TEST(PathTiming, DoesNotBlendACornerIntoAnObstacle)
{
  const Rows path = {{-1.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}};
  for (const double distance : {0.0005, 0.002, 0.004, 0.02, 0.06})
    for (const MotionRule rule : {MotionRule::Bound, MotionRule::Samples})
    {
      const double edge = -0.05 - distance;
      const PointRobot robot({{-0.9, -edge, edge, 0.9}});
      PathTimingOptions options;
      options.motions.rule = rule;
      options.motions.steps.prismatic = 0.001;
      const TimedPath timed = timesOf(robot, path, options);
      expectPromises(*robot.scene()->robot, timed, path, options);
      EXPECT_EQ(collisionsBeside(*robot.checker(), "plane", timed, path), 0);
      EXPECT_EQ(timed.stops, distance < 0.003 ? 1U : 0U) << distance;
      EXPECT_EQ(timed.blends, 1U - timed.stops);
    }
}

/// Three samples, at the ends and in the middle of the curve, miss the wall, but other states of the curve touch it.
TEST(PathTiming, ProvesBlendsFreeBetweenTheirSamples)
{
  const PointRobot robot({{-0.13, 0.055, -0.11, 0.3}});
  const Rows path = {{-1.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}};
  PathTimingOptions options;
  options.motions.steps = {0.2, 0.2};
  const auto collisions = [&]
  {
    const TimedPath timed = timesOf(robot, path, options);
    EXPECT_EQ(timed.blends, 1U);
    return collisionsBeside(*robot.checker(), "plane", timed, path);
  };
  EXPECT_EQ(collisions(), 0);
  options.motions.rule = MotionRule::Samples;
  EXPECT_GT(collisions(), 0);
}

/// Each blend may take half of a segment.
TEST(PathTiming, SharesShortSegmentsBetweenTwoBlends)
{
  const PointRobot robot({});
  const Rows path = {{-1.0, 0.0}, {-0.9, 0.0}, {-0.9, 0.1}, {-0.8, 0.1}, {-0.8, 0.15}, {-0.2, 0.15}};
  PathTimingOptions options;
  options.max_deviation = 1.0;
  const TimedPath timed = timesOf(robot, path, options);
  expectPromises(*robot.scene()->robot, timed, path, options);
  EXPECT_EQ(timed.blends, 4U);
}

TEST(PathTiming, TurnsRoundOnTheSpot)
{
  const PointRobot robot({});
  const Rows path = {{-1.0, 0.0}, {1.0, 0.5}, {-1.0, 0.0}};
  const TimedPath timed = timesOf(robot, path);
  expectPromises(*robot.scene()->robot, timed, path, {});
  EXPECT_EQ(timed.blends, 1U);
}

TEST(PathTiming, HandlesRepeatedWaypointsAndTinySegments)
{
  const PointRobot robot({});
  for (const double tiny : {0.0, 1e-300, 1e-15, 1e-11, 1e-9, 1e-6, 1e-4})
  {
    const Rows path = {{-1.0, 0.0}, {-1.0, tiny}, {0.0, 0.0},        {tiny, 0.0},
                       {tiny, 0.0}, {0.0, tiny},  {1.0, 1.0 - tiny}, {1.0, 1.0}};
    const TimedPath timed = timesOf(robot, path);
    SCOPED_TRACE(tiny);
    expectPromises(*robot.scene()->robot, timed, path, {});
    EXPECT_LT(timed.points.back().seconds, 9.0);
    const Rows short_path = {{0.5, 0.5}, {0.5, 0.5 + tiny}};
    const TimedPath moved = timesOf(robot, short_path);
    if (tiny < 1e-12)
      EXPECT_EQ(moved.points.size(), 1U);
    else
      expectPromises(*robot.scene()->robot, moved, short_path, {});
  }
}

TEST(PathTiming, OfOneWaypointIsOnePointAtRest)
{
  const PointRobot robot({});
  for (const Rows& path : {Rows{{0.5, 0.25}}, Rows{{0.5, 0.25}, {0.5, 0.25}}})
  {
    const TimedPath timed = timesOf(robot, path);
    ASSERT_EQ(timed.points.size(), 1U);
    EXPECT_EQ(timed.points[0].seconds, 0.0);
    EXPECT_EQ(timed.points[0].positions, path[0]);
    EXPECT_EQ(timed.points[0].velocities, (std::vector<double>{0.0, 0.0}));
    EXPECT_EQ(timed.points[0].accelerations, (std::vector<double>{0.0, 0.0}));
  }
}

TEST(PathTiming, RefusesWrongInputInOneLine)
{
  const PointRobot robot({});
  const Rows path = {{-1.0, 0.0}, {1.0, 0.0}};
  const auto fault = [&](const Rows& rows, const PathTimingOptions& options, const std::string& group = "plane")
  { return errorOf([&] { timePath(*robot.scene(), robot.checker(), group, rows, options); }); };
  for (const double factor : {-0.5, 1.5, std::nan("")})
  {
    PathTimingOptions options;
    options.max_velocity_scaling_factor = factor;
    EXPECT_EQ(fault(path, options).find("max_velocity_scaling_factor is "), 0U);
    options = {};
    options.max_acceleration_scaling_factor = factor;
    EXPECT_EQ(fault(path, options).find("max_acceleration_scaling_factor is "), 0U);
  }
  PathTimingOptions options;
  options.max_velocity_scaling_factor = 1.5;
  EXPECT_EQ(fault(path, options), "max_velocity_scaling_factor is 1.5; it must be above 0 and at most 1");
  options = {};
  options.max_deviation = -1.0;
  EXPECT_EQ(fault(path, options), "max_deviation is -1; it must be finite and at least 0");
  EXPECT_EQ(fault({}, {}), "the path has no waypoint; give at least one");
  EXPECT_EQ(fault({{0.0, 0.0}, {1.0}}, {}), "waypoint 1 has 1 values; the robot has 2 variables");
  EXPECT_EQ(fault({{0.0, std::nan("")}}, {}), "waypoint 0: y is nan; it must be finite");
  EXPECT_NE(fault(path, {}, "plain"), "");
}

/// Their points would fill the memory.
TEST(PathTiming, RefusesMotionsOfManyHours)
{
  const PointRobot robot({});
  PathTimingOptions options;
  options.max_velocity_scaling_factor = 1e-5;
  const auto fault = [&] { return errorOf([&] { timesOf(robot, {{-1.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}, options); }); };
  EXPECT_EQ(fault().find("the motion would last 300000 s, more than 10000 s; raise the scaling factors"), 0U)
      << fault();
  for (const double least : {1e-10, 1e-300, std::numeric_limits<double>::denorm_min()})
  {
    options.max_velocity_scaling_factor = least;
    EXPECT_EQ(fault().find("a limit of 'x' times its scaling factor is "), 0U) << fault();
  }
}

TEST(PathTiming, HandlesVeryLargeLimits)
{
  JointLimits fast{"turn"};
  fast.max_velocity = 1e300;
  fast.max_acceleration = 2.0;
  const auto scene = std::make_shared<const PlanningScene>(mobileRobot({fast}));
  const auto row = [](double turn) { return std::vector<double>{0.0, 0.0, 0.0, turn, 0.5}; };
  const Rows path = {row(0.0), row(0.5), row(1.0), row(-0.5)};
  expectPromises(*scene->robot, timePath(*scene, std::make_shared<CpuChecker>(scene), "table", path), path, {});
  fast.max_acceleration = 1e300;
  const auto faster = std::make_shared<const PlanningScene>(mobileRobot({fast}));
  EXPECT_LT(timePath(*faster, std::make_shared<CpuChecker>(faster), "table", path).points.back().seconds, 0.1);
}

TEST(PathTiming, RefusesMotionsOutsideTheGroup)
{
  const auto robot = robotOf(armUrdf(), "<group name='arm'><joint name='arm_1'/></group>");
  const auto scene = std::make_shared<const PlanningScene>(robot);
  std::vector<double> moved = robot->defaultState();
  moved[static_cast<std::size_t>(robot->variableIndex("pan"))] = 0.5;
  EXPECT_EQ(errorOf(
                [&] {
                  timePath(*scene, std::make_shared<CpuChecker>(scene), "arm", {robot->defaultState(), moved});
                })
                .find("motion 0 moves pan, which is not in group 'arm'"),
            0U);
}

TEST(PathTiming, NamesTheLimitsThatItAssumes)
{
  const auto message = [](const std::vector<JointLimits>& limits, const std::string& group)
  {
    const auto scene = std::make_shared<const PlanningScene>(mobileRobot(limits));
    return timePath(*scene, std::make_shared<CpuChecker>(scene), group, {scene->robot->defaultState()}).message;
  };
  EXPECT_EQ(
      message({}, "all"),
      "assumed limits, because neither joint_limits nor the URDF has them: velocity 1 (rad/s or m/s) of world/x, "
      "world/y, world/theta, lift; acceleration 1 (rad/s^2 or m/s^2) of world/x, world/y, world/theta, turn, lift")
      << "the velocity 0 of the lift is no limit";
  JointLimits turn{"turn"};
  turn.max_acceleration = 3.0;
  EXPECT_EQ(message({turn}, "table"), "");
}

TEST(PathTiming, HasTheLimitsOfEachVariableOfABase)
{
  std::vector<JointLimits> limits = {{"world/x"}, {"world/theta"}, {"turn"}};
  limits[0].max_velocity = 0.5;
  limits[0].max_acceleration = 0.2;
  limits[1].max_velocity = 0.3;
  limits[2].max_acceleration = 4.0;
  const auto scene = std::make_shared<const PlanningScene>(mobileRobot(limits));
  const auto checker = std::make_shared<CpuChecker>(scene);
  const Rows path = {
      {0.0, 0.0, 0.0, 0.0, 0.5}, {0.9, -0.5, 1.5, 2.0, 0.5}, {0.9, 0.5, -1.0, -0.5, 0.9}, {0.0, 0.9, 1.0, -3.0, 0.2}};
  const TimedPath timed = timePath(*scene, checker, "all", path);
  expectPromises(*scene->robot, timed, path, {});
  EXPECT_EQ(timed.blends, 2U);
}

/// Half a turn has no shorter direction. The direction is that in which MotionChecker checks the motion.
TEST(PathTiming, TurnsWithoutJumpsByWholeTurns)
{
  const auto scene = std::make_shared<const PlanningScene>(mobileRobot({}));
  const auto checker = std::make_shared<CpuChecker>(scene);
  const auto row = [](double theta, double turn) { return std::vector<double>{0.0, 0.0, theta, turn, 0.5}; };
  const Rows path = {row(3.0, 0.0), row(-3.0, 3.0), row(2.9, -2.0), row(2.9, 40.0), row(2.9, 40.0 + EIGEN_PI)};
  Rows continued = path;
  for (std::size_t i = 1; i < path.size(); ++i)
    for (const std::size_t k : {2U, 3U})
    {
      std::vector<double> middle(5);
      interpolate(*scene->robot, path[i - 1].data(), path[i].data(), 0.5, middle.data());
      continued[i][k] = continued[i - 1][k] + 2.0 * shortestAngularDistance(path[i - 1][k], middle[k]);
    }
  const TimedPath timed = timePath(*scene, checker, "all", path);
  EXPECT_NEAR(std::remainder(timed.points.back().positions[3] - path.back()[3], 2.0 * EIGEN_PI), 0.0, 1e-9);
  EXPECT_LT((arrayOf(timed.points.back().positions) - arrayOf(continued.back())).abs().maxCoeff(), 1e-9);
  continued.front() = timed.points.front().positions;
  continued.back() = timed.points.back().positions;
  expectPromises(*scene->robot, timed, continued, {});
  EXPECT_EQ(errorOf([&] { timePath(*scene, checker, "all", {row(0.0, 1e7)}); }),
            "waypoint 0: turn is 10000000 rad; it must be from -1e6 to 1e6");
}

TEST(PathTiming, StopsADifferentialDriveAtEachWaypoint)
{
  const auto scene = std::make_shared<const PlanningScene>(mobileRobot(
      {}, "planar", "<joint_property joint_name='world' property_name='motion_model' value='diff_drive'/>"));
  const auto checker = std::make_shared<CpuChecker>(scene);
  const auto row = [](double x, double theta, double turn) { return std::vector<double>{x, 0.0, theta, turn, 0.5}; };
  const TimedPath driven =
      timePath(*scene, checker, "all", {row(0.0, 0.0, 0.0), row(0.9, 0.0, 0.5), row(0.9, 1.0, 1.0)});
  EXPECT_EQ(driven.stops, 1U);
  const TimedPath parked =
      timePath(*scene, checker, "all", {row(0.0, 0.0, 0.0), row(0.0, 0.0, 0.5), row(0.0, 0.0, -1.0)});
  EXPECT_EQ(parked.stops, 0U);
}

TEST(PathTiming, StopsWhereAPathWithConstraintsTurns)
{
  const PointRobot robot({});
  const Rows path = {{-1.0, 0.0}, {0.0, 0.0}, {0.5, 0.0}, {0.5, 1.0}};
  PathTimingOptions options;
  EXPECT_EQ(timesOf(robot, path, options).blends, 1U);
  options.path_constraints.joints.push_back({0, -1.0, 0.5});
  const TimedPath timed = timesOf(robot, path, options);
  EXPECT_EQ(timed.blends, 0U);
  EXPECT_EQ(timed.stops, 1U);
  options.max_deviation = 0.0;
  expectPromises(*robot.scene()->robot, timed, path, options);
}

TEST(PathTiming, RefusesAGroupWithAFloatingJoint)
{
  const auto scene = std::make_shared<const PlanningScene>(mobileRobot({}, "floating"));
  const auto checker = std::make_shared<CpuChecker>(scene);
  const auto fault = [&](const std::string& group)
  { return errorOf([&] { timePath(*scene, checker, group, {scene->robot->defaultState()}); }); };
  EXPECT_EQ(fault("all"),
            "group 'all' has the floating joint 'world', so no times are computed: its quaternion has no "
            "limits of velocity; ask for the path without times");
  EXPECT_EQ(fault("table"), "");
}

TEST(PathTiming, StopsWhereTheCallerEndsTheChecks)
{
  const PointRobot robot({});
  const Rows path = {{-1.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}};
  const TimedPath timed = timePath(*robot.scene(), robot.checker(), "plane", path, {}, [] { return true; });
  EXPECT_EQ(timed.stops, 1U);
  EXPECT_EQ(timed.states_checked, 0U);
}

/// Random free waypoints among boxes.
class RandomPaths : public testing::TestWithParam<std::uint64_t>
{
};

void expectPromisesForRandomPaths(const RealRobot& real, const std::string& group, std::uint64_t seed)
{
  SKIP_WITHOUT(real);
  SCOPED_TRACE(real.name + ", seed " + std::to_string(seed));
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double from, double to)
  { return std::uniform_real_distribution<double>(from, to)(generator); };
  const std::shared_ptr<const RobotModel> robot = real.load();
  PlanningScene with_boxes(robot);
  for (int i = 0; i < 6; ++i)
  {
    WorldObject box;
    box.id = "box_" + std::to_string(i);
    do
      box.pose.translation() = Eigen::Vector3d(uniform(-0.8, 0.8), uniform(-0.8, 0.8), uniform(0.0, 1.0));
    while (box.pose.translation().head<2>().norm() < 0.4);  // clear of the robot's base
    box.shapes = {{Box{{uniform(0.05, 0.3), uniform(0.05, 0.3), uniform(0.05, 0.3)}}}};
    with_boxes.objects.push_back(box);
  }
  const auto scene = std::make_shared<const PlanningScene>(std::move(with_boxes));
  const auto checker = std::make_shared<CpuChecker>(scene);
  Rows path;
  const std::vector<double> start = robot->defaultState();
  for (int tries = 0; path.size() < 8 && tries < 2000; ++tries)
  {
    std::vector<double> random(start.size());
    robot->randomState(generator, start.data(), random.data());
    std::vector<double> row = start;
    for (const int i : robot->group(group).variables)
      row[static_cast<std::size_t>(i)] =
          path.empty() ? random[static_cast<std::size_t>(i)]
                       : path.back()[static_cast<std::size_t>(i)] +
                             uniform(0.01, 0.5) *
                                 (random[static_cast<std::size_t>(i)] - path.back()[static_cast<std::size_t>(i)]);
    if (checker->check(row.data(), 1, group).valid[0] != 0)
      path.push_back(row);
  }
  ASSERT_EQ(path.size(), 8U);
  PathTimingOptions options;
  options.max_velocity_scaling_factor = uniform(0.1, 1.0);
  options.max_acceleration_scaling_factor = uniform(0.1, 1.0);
  options.max_deviation = uniform(0.001, 0.1);
  const TimedPath timed = timePath(*scene, checker, group, path, options);
  expectPromises(*robot, timed, path, options);
  EXPECT_EQ(collisionsBeside(*checker, group, timed, path), 0);
  EXPECT_EQ(timed.blends + timed.stops, 6U);
  EXPECT_GT(timed.blends, 0U);
}

TEST_P(RandomPaths, OfAUr5KeepAllPromises)
{
  expectPromisesForRandomPaths(ur5Robotiq(), "manipulator", GetParam());
}

TEST_P(RandomPaths, OfAPandaKeepAllPromises)
{
  expectPromisesForRandomPaths(panda(), "panda_arm", GetParam());
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomPaths, testing::Range<std::uint64_t>(1, repetitions(4, 100)));
}  // namespace
}  // namespace gpu_planning_scene::core
