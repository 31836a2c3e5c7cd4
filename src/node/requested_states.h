#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A field of a request, with its name there, for messages.
template <class Values>
struct RequestField
{
  const char* name;
  const Values& values;
};

/// The variables that a request's rows have values of, after all of the rows' values were looked at. `require_count`
/// throws Error for too many rows. Throws Error: no name, an unknown one, values that are not rows, or not finite.
std::vector<int> requestedColumns(const RobotModel& robot, const RequestField<std::vector<std::string>>& names,
                                  const RequestField<std::vector<double>>& rows,
                                  const std::function<void(std::size_t)>& require_count);

/// Throws Error where some of a rotation's variables are among the columns, and some are not: such a rotation cannot be
/// moved from one to another without those that are missing.
void requireWholeRotations(const RobotModel& robot, const std::vector<int>& columns);
}  // namespace gpu_planning_scene::core
