#pragma once

#include <string>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Generates the text of a compute shader that computes the poses of a robot's links and of their shape instances (see
/// shaders/problem/kinematics.glsl), one state per invocation. The joints' constants are literals in the text, and
/// products with zeros are left out.
std::string kinematicsShader(const RobotModel& robot);
}  // namespace gpu_planning_scene::core
