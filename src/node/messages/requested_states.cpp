#include "node/messages/requested_states.h"

#include <algorithm>
#include <cmath>

#include "base/error_place.h"
#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "model/full_states.h"

namespace gpu_planning_scene::core
{
std::vector<int> requestedColumns(const RobotModel& robot, const RequestField<std::vector<std::string>>& names,
                                  const RequestField<std::vector<double>>& rows,
                                  const std::function<void(std::size_t)>& require_count)
{
  if (names.values.empty())
    throw Error(std::string(names.name) +
                " is empty; name at least one variable, or give a state of the SRDF by its name");
  std::vector<int> columns = variableIndices(robot, names.values);
  const std::size_t width = columns.size();
  const std::vector<double>& values = rows.values;
  if (values.empty())
    throw Error(std::string(rows.name) + " is empty, but " + names.name + " names " + nameList(names.values) +
                "; give rows of " + std::to_string(width) + (width == 1 ? " value" : " values, one per name") +
                (std::string(rows.name) == "positions" ? ", or leave out both for the current state" : ""));
  if (values.size() % width != 0)
    throw Error(std::to_string(values.size()) + " " + rows.name + " are not rows of " + std::to_string(width) +
                " values, one per name of " + names.name);
  require_count(values.size() / width);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw Error(std::string(rows.name) + ": state " + std::to_string(i / width) + ": the position of '" +
                  names.values[i % width] + "' is not a finite number");
  return columns;
}

NamedRow requestedNamedState(const RobotModel& robot, const RequestField<std::string>& field, const char* conflict)
{
  if (conflict != nullptr)
    throw Error(std::string(field.name) + " is '" + field.values + "', but " + conflict +
                " is not empty; give one of the two");
  const NamedState state = robot.namedState(field.values);
  NamedRow row;
  row.values = state.values;
  for (const int variable : state.variables)
    row.names.push_back(robot.variables()[static_cast<std::size_t>(variable)].name);
  return row;
}

RequestedState requestedState(const RobotModel& robot, const RequestField<std::vector<std::string>>& names,
                              const RequestField<std::vector<double>>& values, const RequestField<std::string>& named,
                              const PartialState& current, const std::string& what)
{
  RequestedState requested;
  requested.row = {names.values, values.values};
  if (!named.values.empty())
    requested.row = requestedNamedState(robot, named,
                                        !names.values.empty()    ? names.name
                                        : !values.values.empty() ? values.name
                                                                 : nullptr);
  if (!requested.row.names.empty() || !requested.row.values.empty())
    requested.columns = requestedColumns(
        robot, {names.name, requested.row.names}, {values.name, requested.row.values},
        [&](std::size_t count)
        {
          if (count != 1)
            throw Error(std::string(values.name) + " has " + std::to_string(count) + " rows; give one state");
        });
  requested.state = withErrorPlace(
      what, [&] { return fullStates(robot, requested.columns, requested.row.values.data(), 1, current); });
  return requested;
}

void requireWholeRotations(const RobotModel& robot, const std::vector<int>& columns)
{
  constexpr int kRotation = 3;  // index of the first rotation variable of a floating joint, after the position
  constexpr int kCoefficients = 4;
  for (const Joint& joint : robot.joints())
  {
    if (joint.type != JointType::Floating || joint.first_variable < 0)
      continue;
    const int first = joint.first_variable + kRotation;
    const auto given = std::count_if(columns.begin(), columns.end(),
                                     [&](int column) { return column >= first && column < first + kCoefficients; });
    if (given != 0 && given != kCoefficients)
      throw Error("joint '" + joint.name + "': a motion needs all four variables of its rotation, or none of them");
  }
}
}  // namespace gpu_planning_scene::core
