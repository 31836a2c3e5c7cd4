#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Throws Error unless the row has a finite value for each variable, and its angles of continuous and planar joints are
/// from -1e6 to 1e6 rad. `what`: what the message calls the row.
void validateRow(const RobotModel& robot, const std::vector<double>& row, const std::string& what);
}  // namespace gpu_planning_scene::core
