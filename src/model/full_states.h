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

/// The variables of the SRDF's virtual joint. The joint is not in the URDF and no driver reports it, so a state that
/// does not name them means their defaults: the robot stands at the origin of the planning frame.
std::vector<int> virtualVariables(const RobotModel& robot);

/// Sets planar and floating joints, which move the robot's base, to their values in another state.
void keepBase(const RobotModel& robot, const double* from, double* state);

/// Finds the variable of each column in a table of states. Throws Error if a name is not a variable of the robot, or is
/// given twice.
std::vector<int> variableIndices(const RobotModel& robot, const std::vector<std::string>& names);

/// Completes `count` rows of values for the variables `columns`. The other variables come from `current`. Returns
/// row-major full states. Throws Error if `current` does not know a needed variable.
std::vector<double> fullStates(const RobotModel& robot, const std::vector<int>& columns, const double* rows,
                               std::size_t count, const PartialState& current);
}  // namespace gpu_planning_scene::core
