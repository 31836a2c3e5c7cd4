#pragma once

#include <vector>

#include <moveit/robot_state/robot_state.h>

#include "moveit/shapes/shape_instance.h"

namespace gpu_planning_scene::detector
{
/// The bound of the displacement of each shape instance of the robot, in metres: no point of it moves farther while
/// MoveIt interpolates from one state to another. Each joint moves at a constant speed, so the bound for a fraction of
/// the motion is the same fraction. The bound is infinite in these cases:
///   - a planar joint turns before it drives
///   - a joint follows a continuous joint that passes half a turn
///   - a joint with several variables follows another joint
///   - a quaternion is not normalised
///   - the dot product of the two quaternions is negative: MoveIt turns the longer way at a changing speed
/// `instances`: placed as in the state `placed`.
std::vector<double> displacementBounds(const moveit::core::RobotState& from, const moveit::core::RobotState& to,
                                       const moveit::core::RobotState& placed,
                                       const std::vector<ShapeInstance>& instances);
}  // namespace gpu_planning_scene::detector
