#pragma once

#include <cstdint>

#include <ros/node_handle.h>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A number that is equal for nodes that give the same answers in equal scenes: a hash of the texts of the URDF and the
/// SRDF, the meshes of the robot, the limits of its joints, and the default paddings of objects.
std::uint64_t setupFromParameters(const ros::NodeHandle& node, const RobotModel& robot, const SceneDefaults& defaults);
}  // namespace gpu_planning_scene::core
