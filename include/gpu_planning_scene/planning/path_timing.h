#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
struct PathTimingOptions
{
  /// Fractions of the limits of velocity and acceleration: above 0 and at most 1.
  double max_velocity_scaling_factor = 1.0;
  double max_acceleration_scaling_factor = 1.0;
  /// The largest deviation of any variable from the path at a waypoint (radians or metres); at least 0. With 0, the
  /// robot stops at each waypoint at which the path turns. For a path of followLines, take
  /// CartesianQuery::max_deviation: the default is 500 times that of the lines, and would round their corners by much
  /// more than they allow.
  double max_deviation = 0.05;
  MotionCheckerOptions motions;  ///< the rule by which blends are valid
  /// The constraints that the path fulfils. With constraints, max_deviation counts as 0, because a blend could leave
  /// them.
  KinematicConstraints path_constraints = {};
};

/// Throws Error if a scaling factor or the deviation is out of its range.
void validateTiming(const PathTimingOptions& options);

/// Throws Error if no times can be computed for paths of this group, because it has a floating joint: quaternions have
/// no limits of velocity.
void requireTimes(const RobotModel& robot, const std::string& group);

/// One value per variable of the robot: radians and metres, per second and per second squared.
struct TimedPoint
{
  double seconds = 0.0;  ///< from the start
  std::vector<double> positions;
  std::vector<double> velocities;
  std::vector<double> accelerations;  ///< those that begin at this point; 0 at the last point
};

struct TimedPath
{
  std::vector<TimedPoint> points;
  std::string message;            ///< the variables with assumed limits, in one line; empty if there are none
  std::size_t blends = 0;         ///< waypoints that the robot passes without a stop, on a checked curve beside them
  std::size_t stops = 0;          ///< waypoints between the start and the goal at which it stops
  double seconds = 0.0;           ///< of this computation, with its checks
  double checking_seconds = 0.0;  ///< of the checker
  std::uint64_t states_checked = 0;
};

/// Computes times for a path: rows of all variables, with straight motions between them that are known to be valid (as
/// those of planMotion). They are not checked again. Straight motions are those of interpolate().
///
/// Along a straight motion, the speed has a trapezoidal profile: some variable always has its largest acceleration or
/// its largest velocity. At a waypoint, the robot leaves the path on a parabola. `options.motions` checks this curve
/// itself: under MotionRule::Bound it is proven free, under MotionRule::Samples its samples are free. Where a parabola
/// is not valid, smaller ones are tried; if they are not valid either, the robot stops at the waypoint. It rests at the
/// start and the goal. A joint with Joint::diff_drive that moves is stopped at each waypoint. A blend is checked for
/// collisions only, so each path with path constraints needs PathTimingOptions::path_constraints.
///
/// The limits are those of Variable, times the scaling factors. As in MoveIt, a missing limit of velocity or
/// acceleration counts as 1. A joint that mimics another one has no limits. Acceleration jumps at points, so jerk is
/// not limited. Between two points, the acceleration is constant: cubic interpolation of positions and velocities
/// follows the curve within 1e-4 rad (or m) for accelerations up to 100; so does quintic interpolation, because a point
/// 1 ms before each jump has the old acceleration. Points are at most 0.1 s apart, and times increase by at least 1e-5
/// s. Values of continuous joints and of planar angles continue without jumps by whole turns. Equal waypoints count
/// once: the result of a path that does not move is one point.
///
/// `scene`: that of the checker (StateChecker::setScene); this is not verified. When `stop` returns true, waypoints
/// whose curves are not decided become stops. Thread-safe if each call has a checker of its own. Throws Error for an
/// unknown group; for no row, and a row with a wrong length, a value that is not finite or an angle beyond 1e6 rad
/// (continuous and planar joints); for a motion that moves a variable outside the group, or lasts more than 1e4 s; for
/// a limit below 1e-9; and as validateTiming and requireTimes do. Errors of the checker pass through.
TimedPath timePath(const PlanningScene& scene, const std::shared_ptr<StateChecker>& checker, const std::string& group,
                   const std::vector<std::vector<double>>& waypoints, const PathTimingOptions& options = {},
                   const std::function<bool()>& stop = {});
}  // namespace gpu_planning_scene::core
