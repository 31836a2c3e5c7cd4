#pragma once

#include <random>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The scene's current state, or the robot's default state where the scene has none.
std::vector<double> startState(const PlanningScene& scene);

struct SetValues
{
  std::vector<int> variables;  ///< that the text sets, ascending
  /// That other variables have their defaults, or that a set value is outside its joint's limits; otherwise empty.
  std::string warning;
};

/// Sets variables of a state. `text`: items separated by commas, applied in this order; NAME=VALUE sets a variable, and
/// NAME or GROUP/NAME a state that the SRDF names, for example "ready,joint_1=0.5". Throws UsageError that names the
/// option --state. `has_state`: whether the other variables have values; else they keep their defaults.
SetValues setValues(const RobotModel& robot, const std::string& text, bool has_state, std::vector<double>& state);

/// A random state within the limits. `keep_base`: planar and floating joints keep the values of `start`. Other joints
/// have the same values for both settings.
void randomise(const RobotModel& robot, std::mt19937_64& generator, const std::vector<double>& start, bool keep_base,
               double* state);
}  // namespace gpu_planning_scene::core
