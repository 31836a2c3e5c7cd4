#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A robot state in which some variables may still be unknown.
struct PartialState
{
  /// Only the virtual joint is known.
  explicit PartialState(const RobotModel& robot);
  /// All variables are known; only the virtual joint if `state` is empty.
  PartialState(const RobotModel& robot, const std::vector<double>& state);

  std::vector<double> values;
  std::vector<bool> known;
};

/// Finds the variable of each column in a table of states. Throws Error if a name is not a variable of the robot, or is
/// given twice.
std::vector<int> variableIndices(const RobotModel& robot, const std::vector<std::string>& names);

/// Completes `count` rows of values for the variables `columns`. The other variables come from `current`. Returns
/// row-major full states. Throws Error if `current` does not know a needed variable.
std::vector<double> fullStates(const RobotModel& robot, const std::vector<int>& columns, const double* rows,
                               std::size_t count, const PartialState& current);
}  // namespace gpu_planning_scene::core
