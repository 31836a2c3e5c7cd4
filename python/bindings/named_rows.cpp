#include "bindings/named_rows.h"

#include <algorithm>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "model/full_states.h"

namespace gpu_planning_scene::python
{
namespace
{
Rows emptyRows(std::size_t count, const core::RobotModel& robot)
{
  Rows rows;
  rows.count = count;
  rows.array = ArrayOf<double>(
      std::vector<py::ssize_t>{static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(robot.variables().size())});
  return rows;
}

core::NamedState stateOf(const std::string& name, const core::RobotModel& robot, const std::string& what)
{
  try
  {
    return robot.namedState(name);
  }
  catch (const core::Error& error)
  {
    throw core::Error(what + ": " + error.what());
  }
}

void requireValues(const core::NamedState& state, const std::string& name, const core::RobotModel& robot,
                   const std::string& what, std::vector<bool> known, const char* remedy)
{
  for (const int variable : state.variables)
    known[static_cast<std::size_t>(variable)] = true;
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!known[i])
      missing.push_back(robot.variables()[i].name);
  if (!missing.empty())
    throw core::Error(what + ": the state '" + name + "' of the SRDF has no value for " + core::nameList(missing) +
                      "; " + remedy);
}

/// Warns of passive joints that one of the states does not set.
void warnOfPassiveJoints(const std::vector<std::string>& names, const core::RobotModel& robot, const std::string& what)
{
  for (const std::string& name : names)
  {
    std::vector<bool> given(robot.variables().size(), false);
    for (const int variable : stateOf(name, robot, what).variables)
      given[static_cast<std::size_t>(variable)] = true;
    if (const std::string warning = core::assumedPassiveJoints(robot, given); !warning.empty())
    {
      warnOf({what + ": '" + name + "': " + warning});
      return;
    }
  }
}

/// `base`: a full state.
void writeRow(const core::NamedState& state, const core::RobotModel& robot, const double* base, double* row)
{
  std::copy_n(base, robot.variables().size(), row);
  for (std::size_t i = 0; i < state.variables.size(); ++i)
    row[state.variables[i]] = state.values[i];
}
}  // namespace

std::vector<std::string> namesFrom(py::handle object)
{
  if (py::isinstance<py::str>(object))
    return {object.cast<std::string>()};
  std::vector<std::string> names;
  if (!py::isinstance<py::list>(object) && !py::isinstance<py::tuple>(object))
    return names;
  for (const auto& item : py::reinterpret_borrow<py::sequence>(object))
    if (py::isinstance<py::str>(item))
      names.push_back(item.cast<std::string>());
    else
      return {};
  return names;
}

Rows namedRows(const std::vector<std::string>& names, const core::RobotModel& robot, const std::string& what,
               const std::vector<double>* current)
{
  const core::PartialState base = current == nullptr ? core::PartialState(robot) : core::PartialState(robot, *current);
  const char* remedy = current == nullptr ? "give numbers for all variables"
                                          : "set current_state of the scene, or give numbers for all variables";
  Rows rows = emptyRows(names.size(), robot);
  double* row = rows.array.mutable_data();
  if (current == nullptr || current->empty())
    warnOfPassiveJoints(names, robot, what);
  for (const std::string& name : names)
  {
    const core::NamedState state = stateOf(name, robot, what);
    requireValues(state, name, robot, what, base.known, remedy);
    writeRow(state, robot, base.values.data(), row);
    row += robot.variables().size();
  }
  return rows;
}

void requireNamesOfGroup(const std::vector<std::string>& names, const core::RobotModel& robot, const std::string& group,
                         const std::string& what)
{
  for (const std::string& name : names)
    try
    {
      core::requireVariableOfGroup(robot, group, stateOf(name, robot, what).variables);
    }
    catch (const core::Error& error)
    {
      throw core::Error(what + ": '" + name + "': " + error.what());
    }
}

Rows endsFrom(py::handle ends, const Rows& starts, const core::RobotModel& robot)
{
  const std::vector<std::string> names = namesFrom(ends);
  if (names.empty())
    return rowsFrom(ends, robot, "ends");
  Rows rows = emptyRows(names.size(), robot);
  rows.is_single = py::isinstance<py::str>(ends);
  // The caller refuses different numbers of starts and ends.
  for (std::size_t i = 0; i < std::min(names.size(), starts.count); ++i)
    writeRow(stateOf(names[i], robot, "ends"), robot, starts.data() + i * robot.variables().size(),
             rows.array.mutable_data() + i * robot.variables().size());
  return rows;
}
}  // namespace gpu_planning_scene::python
