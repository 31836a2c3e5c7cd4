#include "gpu_planning_scene/planning/path_timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/seconds_since.h"
#include "base/text/name_list.h"
#include "base/text/number_text.h"
#include "collision/motion/motions_of_group.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "planning/space/valid_row.h"
#include "planning/space/waypoints.h"
#include "planning/timing/blended_path.h"
#include "planning/timing/parabola_check.h"
#include "planning/timing/timed_points.h"
#include "planning/validity/counted_checker.h"

// BlendedPath computes the speeds. Parabolas that are not valid become smaller or stops, and the speeds are computed
// again, until all parabolas are valid. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Row = std::vector<double>;
using Rows = std::vector<Row>;

constexpr double kAssumedLimit = 1.0;  // as in MoveIt
constexpr double kLeastLimit = 1e-9;   // the squares of smaller limits could underflow
constexpr double kLargestLimit = 1e6;  // the squares of larger limits could overflow; no robot reaches this one
constexpr double kLongest = 1e4;       // seconds; the points of longer motions would fill the memory

/// Radians and metres: waypoints that differ by less are equal up to rounding errors.
constexpr double kEqual = 1e-12;

Eigen::ArrayXd arrayOf(const Row& row)
{
  return Eigen::Map<const Eigen::ArrayXd>(row.data(), static_cast<Eigen::Index>(row.size()));
}

void validateFactor(double factor, const char* name)
{
  if (!(factor > 0.0 && factor <= 1.0))
    throw Error(std::string(name) + " is " + numberText(factor) + "; it must be above 0 and at most 1");
}

void validateRows(const RobotModel& robot, const std::string& group, const Rows& rows)
{
  if (rows.empty())
    throw Error("the path has no waypoint; give at least one");
  for (std::size_t i = 0; i < rows.size(); ++i)
    validateRow(robot, rows[i], "waypoint " + std::to_string(i));
  Row states;
  for (const Row& row : rows)
    states.insert(states.end(), row.begin(), row.end());
  requireMotionsOfGroup(robot, group, states.data(), states.data() + robot.variables().size(), rows.size() - 1,
                        "motion");
}

/// The waypoints without repetitions, with angles that continue in the direction of the straight motion between them.
Rows continuousRows(const RobotModel& robot, const Rows& rows)
{
  Rows result;
  for (Row row : rows)
  {
    if (!result.empty())
    {
      const Row& last = result.back();
      continueAngles(robot, last, row);
      if ((arrayOf(row) - arrayOf(last)).abs().maxCoeff() < kEqual)
      {
        // The last of equal waypoints may be the goal, and the first one is the start.
        if (result.size() > 1)
          result.back() = std::move(row);
        continue;
      }
    }
    result.push_back(std::move(row));
  }
  return result;
}

/// The variables of the group that have no limit. `limits` gets all limits, times `factor`.
std::vector<std::string> limitsOf(const RobotModel& robot, const std::string& group,
                                  std::optional<double> Variable::*limit, double factor, Eigen::ArrayXd& limits)
{
  std::vector<std::string> without;
  limits = Eigen::ArrayXd::Constant(static_cast<Eigen::Index>(robot.variables().size()), factor * kAssumedLimit);
  for (const int i : robot.group(group).variables)
  {
    const Variable& variable = robot.variables()[static_cast<std::size_t>(i)];
    if (variable.*limit)
      limits[i] = std::min(factor * *(variable.*limit), kLargestLimit);
    else
      without.push_back(variable.name);
    if (limits[i] < kLeastLimit)
      throw Error("a limit of '" + variable.name + "' times its scaling factor is " + numberText(limits[i]) +
                  "; limits of velocity and acceleration must be at least " + numberText(kLeastLimit));
  }
  return without;
}

std::string assumedLimits(const std::vector<std::string>& velocity, const std::vector<std::string>& acceleration)
{
  std::string text;
  if (!velocity.empty())
    text += "velocity 1 (rad/s or m/s) of " + nameList(velocity);
  if (!acceleration.empty())
    text += (text.empty() ? "" : "; ") + ("acceleration 1 (rad/s^2 or m/s^2) of " + nameList(acceleration));
  return text.empty() ? "" : "assumed limits, because neither joint_limits nor the URDF has them: " + text;
}

bool movesDiffDrive(const RobotModel& robot, const Rows& rows)
{
  for (const Joint& joint : robot.joints())
    for (int i = 0; joint.diff_drive && i < variableCount(joint.type); ++i)
      for (const Row& row : rows)
        if (const auto variable = static_cast<std::size_t>(joint.first_variable) + static_cast<std::size_t>(i);
            row[variable] != rows.front()[variable])
          return true;
  return false;
}

/// Makes parabolas that are not valid smaller, or stops.
void makeValid(BlendedPath& path, const std::function<std::vector<std::uint8_t>(const std::vector<Phase>&)>& validate)
{
  constexpr int kSizes = 3;          // sizes of a parabola that are tried
  constexpr double kSmaller = 0.25;  // of the lengths: half the speed
  std::vector<double> valid_size(path.waypoints());
  std::vector<int> failures(path.waypoints());
  for (;;)
  {
    std::vector<std::size_t> waypoints;
    std::vector<Phase> parabolas;
    for (std::size_t i = 0; i < path.waypoints(); ++i)
      if (path.hasBlend(i) && path.size(i) != valid_size[i])
      {
        waypoints.push_back(i);
        parabolas.push_back(path.blend(i));
      }
    if (waypoints.empty())
      return;
    const std::vector<std::uint8_t> valid = validate(parabolas);
    for (std::size_t k = 0; k < waypoints.size(); ++k)
      if (const std::size_t i = waypoints[k]; valid[k] != 0)
        valid_size[i] = path.size(i);
      else
        path.shrink(i, ++failures[i] < kSizes ? kSmaller : 0.0);
    path.computeSizes();
  }
}

void refuseLongMotion(const std::vector<Phase>& phases)
{
  double duration = 0.0;
  for (const Phase& phase : phases)
    duration += phase.seconds;
  if (!(duration <= kLongest))
    throw Error("the motion would last " + numberText(duration) + " s, more than " + numberText(kLongest) +
                " s; raise the scaling factors, or the limits of velocity and acceleration");
}
}  // namespace

void validateTiming(const PathTimingOptions& options)
{
  validateFactor(options.max_velocity_scaling_factor, "max_velocity_scaling_factor");
  validateFactor(options.max_acceleration_scaling_factor, "max_acceleration_scaling_factor");
  if (!(std::isfinite(options.max_deviation) && options.max_deviation >= 0.0))
    throw Error("max_deviation is " + numberText(options.max_deviation) + "; it must be finite and at least 0");
}

void requireTimes(const RobotModel& robot, const std::string& group)
{
  for (const int joint : robot.group(group).joints)
    if (robot.joints()[static_cast<std::size_t>(joint)].type == JointType::Floating)
      throw Error(
          "group '" + group + "' has the floating joint '" + robot.joints()[static_cast<std::size_t>(joint)].name +
          "', so no times are computed: its quaternion has no limits of velocity; ask for the path without times");
}

TimedPath timePath(const PlanningScene& scene, const std::shared_ptr<StateChecker>& checker, const std::string& group,
                   const std::vector<std::vector<double>>& waypoints, const PathTimingOptions& options,
                   const std::function<bool()>& stop)
{
  const auto begin = std::chrono::steady_clock::now();
  const RobotModel& robot = *scene.robot;
  validateTiming(options);
  validateSteps(options.motions.steps);
  requireTimes(robot, group);
  validateRows(robot, group, waypoints);
  const Rows rows = continuousRows(robot, waypoints);
  Eigen::ArrayXd velocity;
  Eigen::ArrayXd acceleration;
  TimedPath result;
  result.message = assumedLimits(
      limitsOf(robot, group, &Variable::max_velocity, options.max_velocity_scaling_factor, velocity),
      limitsOf(robot, group, &Variable::max_acceleration, options.max_acceleration_scaling_factor, acceleration));
  std::vector<Eigen::ArrayXd> corners;
  for (const Row& row : rows)
    corners.push_back(arrayOf(row));
  const bool is_diff_drive = movesDiffDrive(robot, rows);
  BlendedPath path(std::move(corners), velocity, acceleration,
                   options.path_constraints.isEmpty() ? options.max_deviation : 0.0);
  if (is_diff_drive)
  {
    for (std::size_t i = 0; i < path.waypoints(); ++i)
      path.shrink(i, 0.0);
    path.computeSizes();
  }
  CountedChecker counted(checker);
  makeValid(path, [&](const std::vector<Phase>& parabolas)
            { return validParabolas(robot, counted, group, options.motions, parabolas, stop); });
  for (std::size_t i = 1; i + 1 < path.waypoints(); ++i)
  {
    result.blends += path.hasBlend(i) ? 1 : 0;
    result.stops += path.size(i) == 0.0 ? 1 : 0;
  }
  const std::vector<Phase> phases = path.phases();
  refuseLongMotion(phases);
  result.points = timedPoints(phases, rows.back());
  result.seconds = secondsSince(begin);
  result.checking_seconds = counted.seconds();
  result.states_checked = counted.states();
  return result;
}
}  // namespace gpu_planning_scene::core
