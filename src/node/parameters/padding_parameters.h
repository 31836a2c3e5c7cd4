#pragma once

#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// Reads MoveIt's parameters in the namespace `description` + "_planning": default_robot_padding, default_robot_scale,
/// default_robot_link_padding and default_robot_link_scale (maps of LINK: VALUE), default_object_padding and
/// default_attached_padding. (MoveIt reads the last two and ignores them.) Links that the robot does not have give a
/// warning. Throws Error, which names the parameter.
SceneDefaults defaultsFromParameters(const ros::NodeHandle& node, const std::string& description,
                                     const RobotModel& robot, std::vector<std::string>* warnings);
}  // namespace gpu_planning_scene::core
