#pragma once

#include <string>
#include <vector>

#include "bindings/arguments.h"
#include "gpu_planning_scene/robot_model.h"

// States that the SRDF names.
namespace gpu_planning_scene::python
{
/// A str, or the items of a list or tuple of str; empty for anything else.
std::vector<std::string> namesFrom(py::handle object);

/// The full states of these names, one per row. The other variables have the values of `current`: see rowsFrom().
Rows namedRows(const std::vector<std::string>& names, const core::RobotModel& robot, const std::string& what,
               const std::vector<double>* current);

/// Throws Error if a named state sets no variable of the group, see core::requireVariableOfGroup. `what`: "states".
void requireNamesOfGroup(const std::vector<std::string>& names, const core::RobotModel& robot, const std::string& group,
                         const std::string& what);

/// The ends of motions: as rowsFrom(), but variables that a named state does not set keep the values of the start.
Rows endsFrom(py::handle ends, const Rows& starts, const core::RobotModel& robot);
}  // namespace gpu_planning_scene::python
