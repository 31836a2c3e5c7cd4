#pragma once

#include <cstddef>
#include <vector>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The largest step of any variable between two states of a motion, above 0.
struct MotionSteps
{
  double revolute = 0.0;   ///< radians: angles, and quaternions by half the angle that they turn through
  double prismatic = 0.0;  ///< metres
};

/// Throws Error for a step that is not a finite number above 0.
void validateSteps(const MotionSteps& steps);

/// How far each joint of the robot moves on the straight way from one state to another; a mimic joint by what it makes
/// of its leader's. Fixed joints do not.
std::vector<JointTravel> jointTravel(const RobotModel& robot, const double* from, const double* to);

/// Into how many equal parts, at least 1, such a way is cut, so that no variable moves more than its step in one; as a
/// double, as there may be more than an integer holds.
double segmentCount(const RobotModel& robot, const double* from, const double* to, const MotionSteps& steps);

/// Whether a whole turn of a continuous joint makes another state of it: where a joint mimics it by a multiplier that
/// is no whole number, or is a prismatic one.
bool hasNoPeriod(const RobotModel& robot, const Joint& joint);

/// The shorter way from one angle to another, from -half a turn to half a turn. Finite for all finite angles.
double shortestAngularDistance(double from, double to);

/// The state at `fraction` (0 to 1) of the straight way from one state to another: angles of continuous and planar
/// joints the shorter way round, quaternions by slerp. At 0 and 1 it is `from` and `to` themselves, bit by bit, so an
/// angle beyond half a turn jumps there by whole turns, which is the same place. A joint that hasNoPeriod
/// goes straight from value to value.
void interpolate(const RobotModel& robot, const double* from, const double* to, double fraction, double* state);
}  // namespace gpu_planning_scene::core
