#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A robot state in which some variables may still be unknown.
struct PartialState
{
  /// Only the virtual joint and the passive joints are known. They have their default values. As in MoveIt, a state is
  /// complete without passive joints, because often nobody measures them, for example the casters of a base.
  explicit PartialState(const RobotModel& robot);
  /// All variables are known; the same as above if `state` is empty.
  PartialState(const RobotModel& robot, const std::vector<double>& state);

  std::vector<double> values;
  std::vector<bool> known;
};

/// A warning that passive joints have their default values, with these values, for those whose variables are not
/// `given` (one entry per variable); empty if there are none.
std::string assumedPassiveJoints(const RobotModel& robot, const std::vector<bool>& given);

/// Finds the variable of each column in a table of states. Throws Error if a name is not a variable of the robot, or is
/// given twice.
std::vector<int> variableIndices(const RobotModel& robot, const std::vector<std::string>& names);

/// Throws Error if none of the variables `columns`, which a state sets, is in the group: then the state is meant for
/// another group, and collisions of the links that its variables move would not be found. `group` may be empty.
void requireVariableOfGroup(const RobotModel& robot, const std::string& group, const std::vector<int>& columns);

/// The first variable that is not one of `variables` and differs between two full states; -1: none.
int movedVariableBeyond(const RobotModel& robot, const std::vector<int>& variables, const double* from,
                        const double* to);

/// Completes `count` rows of values for the variables `columns`. The other variables come from `current`. Returns
/// row-major full states. Throws NotKnownYet if `current` does not know a needed variable.
std::vector<double> fullStates(const RobotModel& robot, const std::vector<int>& columns, const double* rows,
                               std::size_t count, const PartialState& current);
}  // namespace gpu_planning_scene::core
