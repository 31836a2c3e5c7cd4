#pragma once

#include <set>
#include <string>

namespace gpu_planning_scene::core
{
/// The texts of all compute shaders that the program gives to OpenGL, with all definitions, and the kinematics of a
/// robot with a joint of each type. Replaces OpenGL by a device that computes nothing. Such a device fails the
/// self-test of its arithmetic, so texts with the definition FLOAT32_TRUSTED 0 are also returned without it.
std::set<std::string> computeShaders(const std::string& folder);
}  // namespace gpu_planning_scene::core
