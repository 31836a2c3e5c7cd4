#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Rows of values at times. Between two rows, the robot moves straight and at a constant rate, see interpolate().
/// Before the first row and after the last one, it stands.
struct TimedRows
{
  std::vector<double> seconds;  ///< of each row, increasing
  std::vector<double> values;   ///< row-major
};

/// A trajectory of some variables of the robot.
struct WatchedTrajectory
{
  std::vector<int> columns;  ///< the variables of its rows, each once
  TimedRows rows;
};

/// Throws Error that names the row unless there are rows, their times are finite and increase, and all values are
/// finite numbers of whole rows.
void validateTrajectory(const WatchedTrajectory& trajectory);

/// The values of a trajectory's variables at a time.
std::vector<double> rowAt(const RobotModel& robot, const WatchedTrajectory& trajectory, double time);

/// Where the robot is on a trajectory.
struct Progress
{
  double time = 0.0;       ///< seconds: the time of the nearest row
  double deviation = 0.0;  ///< the largest difference of any variable from that row: radians or metres
};

/// The largest difference of any variable of a trajectory from its row at a time. `values`: those of its variables.
double deviationAt(const RobotModel& robot, const WatchedTrajectory& trajectory, const std::vector<double>& values,
                   double time);

/// Where a robot is that was at the time `from` of its trajectory and has gone on since. The search starts at `from`,
/// and goes forward along the trajectory as long as this brings it nearer to `values` (those of its variables). So it
/// never takes a later row for the robot's place where a trajectory crosses itself or turns back; a robot that was lost
/// for long has a large deviation instead. A part in which the trajectory stands has no length, and counts as passed.
Progress progressFrom(const RobotModel& robot, const WatchedTrajectory& trajectory, const std::vector<double>& values,
                      double from);

/// The motion of the whole robot from a time to the end of the last trajectory: rows of all variables at the times of
/// all rows. `delays`: seconds, one per trajectory: its rows come so much later. `state`: the values of the variables
/// without a trajectory, one value per variable. No variable may be in two trajectories.
/// Throws Error for a time or a delay that is not finite.
TimedRows motionOfAll(const RobotModel& robot, const std::vector<const WatchedTrajectory*>& trajectories,
                      const std::vector<double>& delays, const std::vector<double>& state, double from);

/// The outlook of a motion: is it free, and until when? All times are those of its rows.
struct MotionOutlook
{
  bool free = false;        ///< the whole motion is free by the checker's rule
  double free_until = 0.0;  ///< the motion is free by the rule up to this time; the first time if nothing is free
  /// The first sample that collides, or around which the motion is not proven free. Infinity if the motion is free.
  double collision = std::numeric_limits<double>::infinity();
  BodyPair colliding = kNoPair;  ///< a pair that collides then; kNoPair if the motion is only not proven free
  std::vector<double> state;     ///< the state at the time `collision`; empty if the motion is free
  /// The latest time at which the robot can begin to brake so that it stands at `free_until`. It brakes along the
  /// motion: the rate falls evenly to 0, and this decelerates no joint by more than Variable::max_acceleration (as in
  /// timePath, 1 if there is no limit). A joint that the motion itself slows down decelerates by both together.
  /// Infinity if the motion is free. Before the first time of the motion, it is too late.
  double brake_by = std::numeric_limits<double>::infinity();
};

/// Checks a motion of the whole robot, as motionOfAll() makes it: by the samples and, under MotionRule::Bound, also
/// between them. `checker`: of all pairs (group ""). `stop`: as for MotionChecker::check; throws Cancelled after it has
/// returned true. Throws the errors of MotionChecker::check.
MotionOutlook outlookOf(const MotionChecker& checker, const RobotModel& robot, const TimedRows& motion,
                        const std::function<bool()>& stop = {});
}  // namespace gpu_planning_scene::core
