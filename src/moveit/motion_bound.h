#pragma once

#include <vector>

#include <moveit/robot_state/robot_state.h>

#include "moveit/part.h"

namespace gpu_planning_scene::detector
{
/// How far each part of the robot can move, at most, while MoveIt interpolates from one state to another: metres over
/// the whole motion. Over a fraction of the motion it is that fraction, because each joint moves at a constant speed.
/// Infinite where there is no bound: planar joints that turn before they drive, joints that follow a continuous joint
/// past half a turn, quaternions that are not normalised, and quaternions with a negative product, between which MoveIt
/// turns the longer way at a changing speed. `parts`: placed as in the state `placed`.
std::vector<double> displacementBounds(const moveit::core::RobotState& from, const moveit::core::RobotState& to,
                                       const moveit::core::RobotState& placed, const std::vector<Part>& parts);
}  // namespace gpu_planning_scene::detector
