#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene
{
/// The variables that a request's rows have values of, after all of the request's values were looked at. `what`: the
/// values' name in the request, for messages. `require_count` throws Error for too many rows. Throws Error: an unknown
/// name, values that are not rows, or not finite.
std::vector<int> requestedColumns(const RobotModel& robot, const std::vector<std::string>& joint_names,
                                  const std::vector<double>& values, const std::string& what,
                                  const std::function<void(std::size_t)>& require_count);

/// Throws Error where some of a rotation's variables are among the columns, and some are not: such a rotation cannot be
/// moved from one to another without those that are missing.
void requireWholeRotations(const RobotModel& robot, const std::vector<int>& columns);
}  // namespace gpu_planning_scene
