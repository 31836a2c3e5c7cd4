#pragma once

#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The variables of the SRDF's virtual joint. No driver reports this joint, because it is not in the URDF. So a state
/// without these variables gets their default values: the robot stands at the origin of the planning frame.
std::vector<int> virtualVariables(const RobotModel& robot);
}  // namespace gpu_planning_scene::core
