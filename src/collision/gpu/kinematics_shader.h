#pragma once

#include <string>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The text of a compute shader that finds the poses of a robot's links, and of what moves with them (see
/// shaders/problem/kinematics.glsl), one state a lane: the joints' constants stand in it as numbers, and products with
/// zeros are left out.
std::string kinematicsShader(const RobotModel& robot);
}  // namespace gpu_planning_scene::core
