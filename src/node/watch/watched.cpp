#include "node/watch/watched.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text/number_text.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "model/full_states.h"
#include "node/checks/requested_motions.h"
#include "node/endpoints/respond.h"
#include "node/messages/requested_states.h"
#include "node/messages/requested_trajectory.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kFresh = 0.25;     // seconds: values of joint_states count up to this age
constexpr double kArrived = 0.01;   // radians or metres: a robot this near to the last row has reached it
constexpr double kStands = 1e-3;    // radians or metres: a robot that moves by no more stands
constexpr double kStopped = 1.0;    // seconds: a robot that stands for so long has stopped
constexpr double kSetBack = 1.0;    // seconds: a clock that goes back by more is that of a simulation that begins again
constexpr double kAtRequest = 0.5;  // seconds: a start this near to the request is that of the current state

std::vector<double> timesOf(const WatchTrajectory::Request& request)
{
  std::vector<double> times;
  for (const auto& point : request.joint_trajectory.points)
    times.push_back(point.time_from_start.toSec());
  if (times.empty())
    for (const auto& point : request.multi_dof_joint_trajectory.points)
      times.push_back(point.time_from_start.toSec());
  return times;
}

/// The values of the trajectory's variables in a state.
std::vector<double> valuesOf(const WatchedTrajectory& trajectory, const std::vector<double>& state)
{
  std::vector<double> values;
  for (const int column : trajectory.columns)
    values.push_back(state[static_cast<std::size_t>(column)]);
  return values;
}

bool movesFloatingJoint(const RobotModel& robot, const WatchedTrajectory& trajectory)
{
  return std::any_of(
      robot.joints().begin(), robot.joints().end(),
      [&](const Joint& joint)
      {
        return joint.type == JointType::Floating &&
               std::count(trajectory.columns.begin(), trajectory.columns.end(), joint.first_variable + 3) != 0;
      });
}

void requireSensible(const WatchTrajectory::Request& request, const ros::Time& now)
{
  if (request.id.empty())
    throw Error("the trajectory has no name; give one in the field id");
  if (now.isZero())
    throw Error("the ROS clock stands at 0; with use_sim_time, start /clock first");
  if (!(request.max_deviation >= 0.0) || !std::isfinite(request.max_deviation))
    throw Error("max_deviation is " + std::to_string(request.max_deviation) +
                "; it must be a finite number, at least 0 (0: no limit)");
  if (request.follow_joint_states && request.max_deviation == 0.0)
    throw Error(
        "follow_joint_states needs max_deviation, for example 0.1: without it, a robot far beside its "
        "trajectory would count as being on it");
}

/// Seconds: of the oldest value of the trajectory's variables, since its stamp or its arrival. Infinite if a value was
/// not measured.
double ageOf(const WatchedTrajectory& trajectory, const Snapshot& scene, const ros::Time& now)
{
  double oldest = 0.0;
  for (const int column : trajectory.columns)
  {
    const auto variable = static_cast<std::size_t>(column);
    oldest = std::max(oldest, scene.ages[variable]);
    // In doubles: times of ROS cannot be subtracted if they differ by more than 68 years.
    if (const std::int64_t stamp = scene.stamps[variable]; stamp != 0)
      oldest = std::max(oldest, now.toSec() - 1e-9 * static_cast<double>(stamp));
  }
  return oldest;
}

/// Seconds since when the robot stands, by its measured values.
double standsFor(const std::vector<double>& values, const ros::Time& now, Watched& watched)
{
  const auto is_near = [](double a, double b) { return std::abs(a - b) <= kStands; };
  if (watched.stood_at.empty() || now < watched.stands_since ||
      !std::equal(values.begin(), values.end(), watched.stood_at.begin(), is_near))
  {
    watched.stood_at = values;
    watched.stands_since = now;
  }
  return (now - watched.stands_since).toSec();
}

/// Whether all rows after a time are within this distance of the last row.
bool isRestWithin(const RobotModel& robot, const WatchedTrajectory& trajectory, double time, double distance)
{
  const std::vector<double>& seconds = trajectory.rows.seconds;
  const std::vector<double> end = rowAt(robot, trajectory, seconds.back());
  return std::all_of(std::upper_bound(seconds.begin(), seconds.end(), time), seconds.end(),
                     [&](double row) { return deviationAt(robot, trajectory, end, row) <= distance; });
}

bool isWholeWithin(const RobotModel& robot, const WatchedTrajectory& trajectory, double distance)
{
  return isRestWithin(robot, trajectory, -std::numeric_limits<double>::infinity(), distance);
}

/// A controller moves from the current state to a first point that is later than the start.
void addCurrentState(const Snapshot& scene, const ros::Time& now, Watched& watched)
{
  WatchedTrajectory& trajectory = watched.trajectory;
  const double first = trajectory.rows.seconds.front();
  if (!(first > 0.0))
    return;
  const std::vector<bool> known = scene.partialState().known;
  const bool are_known = std::all_of(trajectory.columns.begin(), trajectory.columns.end(),
                                     [&](int column) { return known[static_cast<std::size_t>(column)]; });
  if (!are_known || (!watched.start.isZero() && std::abs((watched.start - now).toSec()) > kAtRequest))
    throw Error("the first point is at " + std::to_string(first) +
                " s, and the robot's state at the start is not "
                "known; give a first point at 0 s");
  std::vector<int> others;
  for (int variable = 0; variable < static_cast<int>(scene.state.size()); ++variable)
    if (std::count(trajectory.columns.begin(), trajectory.columns.end(), variable) == 0)
      others.push_back(variable);
  if (const std::string fault = scene.endedVariable(others); !fault.empty())
    throw Error("the first point is at " + std::to_string(first) + " s, and " + fault + "; give a first point at 0 s");
  const std::vector<double> values = valuesOf(trajectory, scene.state);
  trajectory.rows.seconds.insert(trajectory.rows.seconds.begin(), 0.0);
  trajectory.rows.values.insert(trajectory.rows.values.begin(), values.begin(), values.end());
}

/// Throws Error for a motion that a controller may make in another way than it is checked.
void requireOneWay(const RobotModel& robot, const std::vector<double>& states, std::size_t rows)
{
  const auto name_of = [](std::size_t row) { return "row " + std::to_string(row); };
  if (const std::string turn = longTurn(robot, states, name_of); !turn.empty())
    throw Error(turn);
  const std::size_t width = robot.variables().size();
  if (const std::string sideways = sidewaysMotion(robot, states.data(), states.data() + width, rows - 1, "part");
      !sideways.empty())
    throw Error(sideways);
}
}  // namespace

Watched watchedOf(const WatchTrajectory::Request& request, const Snapshot& scene, const ros::Time& now,
                  std::string& warnings)
{
  requireSensible(request, now);
  const RobotModel& robot = *scene.scene->robot;
  const RequestedTrajectory requested =
      requestedTrajectory(robot, request.joint_trajectory, request.multi_dof_joint_trajectory);
  requireWholeRotations(robot, requested.columns);

  Watched watched;
  watched.id = request.id;
  watched.follows = request.follow_joint_states;
  watched.max_deviation = request.max_deviation;
  const std_msgs::Header& header = request.joint_trajectory.points.empty() ? request.multi_dof_joint_trajectory.header
                                                                           : request.joint_trajectory.header;
  watched.start = header.stamp;
  watched.looked_at = now;
  WatchedTrajectory& trajectory = watched.trajectory;
  trajectory.columns = requested.columns;
  trajectory.rows = {timesOf(request), requested.rows};
  if (watched.max_deviation > 0.0 && movesFloatingJoint(robot, trajectory))
    throw Error(
        "the trajectory moves a floating joint, whose rotation joint_states does not bring; leave "
        "follow_joint_states and max_deviation out");
  addCurrentState(scene, now, watched);
  validateTrajectory(trajectory);
  const std::size_t rows = trajectory.rows.seconds.size();
  const std::vector<double> states =
      fullStates(robot, trajectory.columns, trajectory.rows.values.data(), rows, PartialState(robot, scene.state));
  validateStates(robot, states.data(), rows, "row");
  requireOneWay(robot, states, rows);
  addWarning(beyondLimits(robot, states.data(), rows, [](std::size_t row) { return "row " + std::to_string(row); }),
             warnings);
  return watched;
}

void findPlace(const Snapshot& scene, const ros::Time& now, Watched& watched)
{
  const WatchedTrajectory& trajectory = watched.trajectory;
  const RobotModel& robot = *scene.scene->robot;
  const double age = ageOf(trajectory, scene, now);
  const bool is_measured = age <= kFresh;
  if (!is_measured)
    watched.deviation = std::numeric_limits<double>::quiet_NaN();
  if (!is_measured && watched.max_deviation > 0.0)
    throw Error("'" + watched.id + "': joint_states has no values of all its joints of the last " +
                std::to_string(kFresh).substr(0, 4) + " s" +
                (std::isfinite(age) ? "; the oldest is " + numberText(age) +
                                          " s old: look for a driver that has stopped or is late, or for clocks "
                                          "that differ"
                                    : ""));

  const double by_clock = watched.start.isZero() ? 0.0 : (now - watched.start).toSec();
  const double end = trajectory.rows.seconds.back();
  const std::vector<double> values = valuesOf(trajectory, scene.state);
  if (watched.follows)
  {
    const double before = (watched.looked_at - now).toSec() > kSetBack ? 0.0 : watched.time;
    const Progress progress = progressFrom(robot, trajectory, values, before);
    watched.time = progress.time;
    watched.deviation = progress.deviation;
    watched.age = age;
    const double from_end = deviationAt(robot, trajectory, values, end);
    const bool has_arrived = from_end <= kArrived && isRestWithin(robot, trajectory, progress.time, kArrived);
    // Controllers stop within a tolerance of the goal. A robot that has never been far from it must be nearer to it
    // than to its start.
    const bool has_left = !isWholeWithin(robot, trajectory, watched.max_deviation) ||
                          deviationAt(robot, trajectory, values, trajectory.rows.seconds.front()) > from_end + kArrived;
    const bool may_have_arrived = from_end <= watched.max_deviation && has_left &&
                                  isRestWithin(robot, trajectory, progress.time, watched.max_deviation);
    watched.has_ended =
        by_clock >= end && (has_arrived || (may_have_arrived && standsFor(values, now, watched) >= kStopped));
  }
  else
  {
    watched.time = by_clock;
    if (is_measured)
      watched.deviation = deviationAt(robot, trajectory, values, by_clock);
    // A robot that is still away from the last row moves on, unless its goal was cancelled.
    const bool is_late = watched.max_deviation > 0.0 && watched.deviation > watched.max_deviation;
    watched.has_ended = by_clock >= end && (!is_late || standsFor(values, now, watched) >= kStopped);
  }
  watched.looked_at = now;
}
}  // namespace gpu_planning_scene::core
