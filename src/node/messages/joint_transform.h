#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/Transform.h>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The values of a planar or floating joint's variables for a transform of MoveIt's messages: the motion of the joint,
/// that is, the pose of the child link in the joint's frame. The joint's frame is the frame of the parent link, moved
/// by the joint's origin. `frame`: the frame in the message's header: empty or the planning frame, as MoveIt writes it
/// for all joints. `where` begins the messages. Throws Error for other frames, for joints of other types, and for
/// transforms that are not finite.
std::vector<double> variablesOfTransform(const RobotModel& robot, const Joint& joint, const std::string& frame,
                                         const geometry_msgs::Transform& transform, const std::string& where);
}  // namespace gpu_planning_scene::core
