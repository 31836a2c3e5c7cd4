#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "collision/cpu/lanes/lane_scene.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The states in which the frames of a robot are compared: random, but the same in each call. Rows of the robot's
/// variables.
std::vector<double> statesOfFrameCheck(const RobotModel& robot);
constexpr std::size_t kFrameCheckStates = 64;

/// Compares the frames that the device has placed in these states with those of the robot model. `rows`: as
/// shaders/proofs/state_proofs.glsl writes them, POSE_FLOATS for a frame and a state. `verdicts`: of the states; frames
/// of a state that tables decide, or whose bounds do not hold, are not there. Returns one line that names a link of a
/// frame whose error exceeds its bound, or an empty text.
std::string findFrameFault(const RobotModel& robot, const LaneScene& scene, const std::vector<double>& states,
                           const std::vector<float>& rows, const std::vector<std::uint32_t>& verdicts);
}  // namespace gpu_planning_scene::core
