#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A robot state of which some variables may not be known yet.
struct PartialState
{
  /// Nothing is known.
  explicit PartialState(const RobotModel& robot);
  /// All of `state` is known; nothing if it is empty.
  PartialState(const RobotModel& robot, const std::vector<double>& state);

  std::vector<double> values;
  std::vector<bool> known;
};

/// Where the columns of a table of states belong in a full state. Throws Error for a name that is not a variable of the
/// robot, and for one given twice.
std::vector<int> variableIndices(const RobotModel& robot, const std::vector<std::string>& names);

/// Full states, row-major, from `count` rows of values for `columns`; the other variables come from `current`.
/// Throws Error if one of those is not known there.
std::vector<double> fullStates(const RobotModel& robot, const std::vector<int>& columns, const double* rows,
                               std::size_t count, const PartialState& current);
}  // namespace gpu_planning_scene::core
