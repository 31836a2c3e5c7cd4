#pragma once

#include <cstddef>
#include <string>

#include "collision/cpu/lanes/lane_scene.h"

namespace gpu_planning_scene::core
{
/// The text of the compute shader that proves verdicts of states (shaders/proofs/state_proofs.glsl). What depends on
/// the robot and its checked pairs is straight-line code with constants. The world and attached objects are data, so
/// that they may change without another program. `attached_centers`: room for the centres of a scene with attached
/// objects; 0: there are none.
std::string stateShader(const LaneScene& scene, std::size_t attached_centers);
}  // namespace gpu_planning_scene::core
