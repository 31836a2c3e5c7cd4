#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "model/full_states.h"

namespace gpu_planning_scene::core
{
/// The values of a request's field, and the name of the field for error messages.
template <class Values>
struct RequestField
{
  const char* name;
  const Values& values;
};

/// The variable indices of the columns of `rows`. Checks all values of the rows. `require_count` throws Error for too
/// many rows. Throws Error if there is no name, an unknown name or no value, if the values do not make whole rows, or
/// if a value is not finite.
std::vector<int> requestedColumns(const RobotModel& robot, const RequestField<std::vector<std::string>>& names,
                                  const RequestField<std::vector<double>>& rows,
                                  const std::function<void(std::size_t)>& require_count);

/// The names of variables, and rows of their values, as in a request.
struct NamedRow
{
  std::vector<std::string> names;
  std::vector<double> values;
};

/// The row of a state that the SRDF names. `field`: the field of the request that has the name. `conflict`: a field of
/// the request that must be empty but is not; null if there is none. Throws Error if there is one, or if the SRDF has
/// no such state.
NamedRow requestedNamedState(const RobotModel& robot, const RequestField<std::string>& field, const char* conflict);

/// One full state of a request: the values that it names, and otherwise those of the current state.
struct RequestedState
{
  std::vector<double> state;
  NamedRow row;              ///< what the request, or the SRDF's state that it names, sets
  std::vector<int> columns;  ///< the variables of `row`
};

/// `names`, `values`: a row of values. `named`: instead, a state that the SRDF names. If all are empty: the current
/// state. `what`: "the start", begins messages about values that nobody knows. Throws Error for a wrong request.
RequestedState requestedState(const RobotModel& robot, const RequestField<std::vector<std::string>>& names,
                              const RequestField<std::vector<double>>& values, const RequestField<std::string>& named,
                              const PartialState& current, const std::string& what);

/// Throws Error if the columns have only some of the four variables of a floating joint's rotation: a motion between
/// two such rotations is not defined.
void requireWholeRotations(const RobotModel& robot, const std::vector<int>& columns);
}  // namespace gpu_planning_scene::core
