#pragma once

#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Reads the limits of the joints of joint_limits in the parameters `folder`, usually /robot_description_planning, as
/// MoveIt's RobotModelLoader does. `warnings` (may be null) gets a line for each contradiction. Throws Error, which
/// names the parameter, for a value of the wrong type and for a misspelt name of a limit.
std::vector<JointLimits> jointLimitsFromParameters(const ros::NodeHandle& node, const std::string& folder,
                                                   std::vector<std::string>* warnings);
}  // namespace gpu_planning_scene::core
