#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Largest change of any variable between two neighbouring samples of a motion. Both values must be above 0.
struct MotionSteps
{
  double revolute = 0.0;   ///< radians: for angles, and for half the rotation angle of quaternions
  double prismatic = 0.0;  ///< metres
};

/// Throws Error if a step is not a finite number above 0.
void validateSteps(const MotionSteps& steps);

/// Displacement of each joint of the robot along the straight motion between two states, one entry per joint. A mimic
/// joint moves by its leader's displacement times the magnitude of its multiplier. Fixed joints have 0.
std::vector<JointTravel> jointTravel(const RobotModel& robot, const double* from, const double* to);

/// Number of equal segments of the straight motion, at least 1: the smallest number at which no variable changes by
/// more than its step within a segment. It is a double because it can exceed the range of integers.
double segmentCount(const RobotModel& robot, const double* from, const double* to, const MotionSteps& steps);

/// True if a whole turn of a continuous joint leads to the same robot state. False if a revolute or continuous joint
/// mimics it with a multiplier that is not a whole number, or if a prismatic joint mimics it.
bool isPeriodic(const RobotModel& robot, const Joint& joint);

/// The signed rotation, in radians, from one angle to another in the shorter direction: -pi to pi. It is finite for all
/// finite angles.
double shortestAngularDistance(double from, double to);

/// Writes the state at `fraction` (0 to 1) of the straight motion from one state to another. Angles of continuous and
/// planar joints turn in the shorter direction, quaternions are interpolated by slerp, and all other variables
/// linearly. A continuous joint that is not periodic (isPeriodic) is interpolated linearly too. At 0 and 1 the result
/// equals `from` or `to` bit by bit. If an angle differs by more than half a turn between `from` and `to`, its value
/// jumps by whole turns as `fraction` reaches 1. The robot itself does not jump.
void interpolate(const RobotModel& robot, const double* from, const double* to, double fraction, double* state);

/// The first of `count` straight motions in which a joint with Joint::diff_drive moves sideways by more than 1 mm (on
/// a long way, 1 mm for each metre), or turns by more than 1 mrad while it drives, as a message; empty: there is none.
/// MotionChecker and the trajectory checks do not look at it. `starts`, `ends`: as for MotionChecker::check. `what`:
/// what the message calls a motion.
std::string sidewaysMotion(const RobotModel& robot, const double* starts, const double* ends, std::size_t count,
                           const std::string& what);
}  // namespace gpu_planning_scene::core
