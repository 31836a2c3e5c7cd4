#include "node/watch/watched.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "model/full_states.h"
#include "node/messages/requested_states.h"
#include "node/messages/requested_trajectory.h"

namespace gpu_planning_scene::core
{
namespace
{
// A robot that is slower than its trajectory is found again, but not at a later place of a trajectory that crosses
// itself: a look may find at most twice the time that has passed, plus this time, in seconds.
constexpr double kAhead = 0.2;

// A robot rarely reaches the last row of its trajectory to the last bit. In the last seconds before it, it has arrived
// if the time of the trajectory is over.
constexpr double kArrived = 0.1;

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

template <class Flags>
bool all(const WatchedTrajectory& trajectory, const Flags& flags)
{
  return std::all_of(
      trajectory.columns.begin(), trajectory.columns.end(),
      [&](int column) { return flags[static_cast<std::size_t>(column)]; });
}
}  // namespace

Watched watchedOf(const WatchTrajectory::Request& request, const Snapshot& scene, const ros::Time& now)
{
  const RobotModel& robot = *scene.scene->robot;
  if (request.id.empty())
    throw Error("the trajectory has no name; give one in the field id");
  if (now.isZero())
    throw Error("the ROS clock stands at 0; with use_sim_time, start /clock first");
  if (!(request.max_deviation >= 0.0) || !std::isfinite(request.max_deviation))
    throw Error("max_deviation is " + std::to_string(request.max_deviation) +
                "; it must be a finite number, at least 0 (0: no limit)");
  if (request.follow_joint_states && request.max_deviation == 0.0)
    throw Error(
        "follow_joint_states needs max_deviation, for example 0.1: without it, a robot far beside its trajectory "
        "would count as being on it");
  const RequestedTrajectory requested =
      requestedTrajectory(robot, request.joint_trajectory, request.multi_dof_joint_trajectory);
  requireWholeRotations(robot, requested.columns);

  Watched watched;
  watched.id = request.id;
  watched.follows = request.follow_joint_states;
  watched.max_deviation = request.max_deviation;
  const std_msgs::Header& header = request.joint_trajectory.points.empty() ? request.multi_dof_joint_trajectory.header
                                                                           : request.joint_trajectory.header;
  watched.start = header.stamp.isZero() ? now : header.stamp;
  watched.looked_at = std::min(watched.start, now);
  WatchedTrajectory& trajectory = watched.trajectory;
  trajectory.columns = requested.columns;
  trajectory.rows = {timesOf(request), requested.rows};
  if (trajectory.rows.seconds.front() > 0.0)
  {
    if (!all(trajectory, scene.partialState().known))
      throw Error("the first point is at " + std::to_string(trajectory.rows.seconds.front()) +
                  " s, and the current state has no values for all of its joints; give a first point at 0 s");
    const std::vector<double> first = valuesOf(trajectory, scene.state);
    trajectory.rows.seconds.insert(trajectory.rows.seconds.begin(), 0.0);
    trajectory.rows.values.insert(trajectory.rows.values.begin(), first.begin(), first.end());
  }
  validateTrajectory(trajectory);
  const std::size_t rows = trajectory.rows.seconds.size();
  const std::vector<double> states =
      fullStates(robot, trajectory.columns, trajectory.rows.values.data(), rows, PartialState(robot, scene.state));
  validateStates(robot, states.data(), rows, "waypoint");
  return watched;
}

void findProgress(const Snapshot& scene, const ros::Time& now, Watched& watched)
{
  const WatchedTrajectory& trajectory = watched.trajectory;
  const RobotModel& robot = *scene.scene->robot;
  const bool is_measured = all(trajectory, scene.measured);
  if (!is_measured)
    watched.progress.deviation = std::numeric_limits<double>::quiet_NaN();
  if (!is_measured && (watched.follows || watched.max_deviation > 0.0))
    throw Error("'" + watched.id + "': joint_states has brought no values of all its joints in the last second");
  const double by_clock = (now - watched.start).toSec();
  const std::vector<double> values = valuesOf(trajectory, scene.state);
  if (watched.follows)
  {
    const double passed = (now - watched.looked_at).toSec();
    if (passed < 0.0)
      watched.progress.time = 0.0;  // the clock went back, as in a simulation that begins again
    watched.progress = nearestRow(
        robot, trajectory, values, watched.progress.time,
        std::min(watched.progress.time + 2.0 * std::max(passed, 0.0) + kAhead, trajectory.rows.seconds.back()));
  }
  else
  {
    watched.progress = nearestRow(robot, trajectory, values, by_clock, by_clock);
    watched.progress.time = by_clock;
  }
  if (!is_measured)
    watched.progress.deviation = std::numeric_limits<double>::quiet_NaN();
  watched.looked_at = now;
}

bool hasEnded(const Watched& watched)
{
  const double end = watched.trajectory.rows.seconds.back();
  const bool is_over = (watched.looked_at - watched.start).toSec() >= end;
  return watched.progress.time >= (watched.follows && is_over ? end - kArrived : end);
}
}  // namespace gpu_planning_scene::core
