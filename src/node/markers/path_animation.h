#pragma once

#include <vector>

#include "gpu_planning_scene/planning/path_timing.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
constexpr double kAnimationSeconds = 4.0;  // of a path without times
constexpr double kAnimationPause = 1.0;    // seconds at the end of the path

/// States of a path, rows of all variables, and their times. Between two states, the robot moves as interpolate() says.
struct AnimatedPath
{
  std::vector<std::vector<double>> states;
  std::vector<double> seconds;  ///< ascending from 0, one per state
};

/// The path takes kAnimationSeconds, and the variable that moves most between two waypoints has the same speed on the
/// whole path (radians or metres per second).
AnimatedPath pathAtConstantSpeed(const RobotModel& robot, const std::vector<std::vector<double>>& waypoints);

/// The path at its own times.
AnimatedPath pathAtItsTimes(const TimedPath& timed);

/// The state of an animation that runs since `seconds`. It repeats the path, and pauses at the end. `path`: at least
/// one state.
std::vector<double> animatedState(const RobotModel& robot, const AnimatedPath& path, double seconds);
}  // namespace gpu_planning_scene::core
