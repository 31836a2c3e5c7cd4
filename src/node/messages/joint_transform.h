#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/Transform.h>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The values of a planar or floating joint's variables at a transform relative to its parent link. `frame`: the frame
/// in the message's header: empty, the planning frame or the parent link. (MoveIt writes the planning frame even for
/// joints with another parent.) `where` begins the messages. Throws Error for other frames, for joints of other types,
/// and for transforms that are not finite.
std::vector<double> variablesOfTransform(const RobotModel& robot, const Joint& joint, const std::string& frame,
                                         const geometry_msgs::Transform& transform, const std::string& where);
}  // namespace gpu_planning_scene::core
