#pragma once

#include <string>

#include "collision/cpu/lanes/lane_scene.h"

namespace gpu_planning_scene::core
{
/// GLSL statements that read the values of a state, v0, v1 and so on, and define `bounded`: whether the error bounds
/// hold for them.
std::string valuesText(const LaneScene& scene);

/// GLSL statements that place the frames of the scene's robot and the centres that move with links: forward kinematics
/// in float, as straight-line code. They set `placed` to false if a quaternion is too short.
std::string framesText(const LaneScene& scene);
}  // namespace gpu_planning_scene::core
