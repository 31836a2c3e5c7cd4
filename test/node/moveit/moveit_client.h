#pragma once

#include <string>

#include <moveit/robot_model/robot_model.h>
#include <moveit_msgs/CollisionObject.h>
#include <moveit_msgs/PlanningScene.h>

#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// MoveIt's model of its test robot panda. Later child processes find panda's meshes too.
moveit::core::RobotModelPtr moveItPanda();
/// A box `x` metres in front of the robot.
moveit_msgs::CollisionObject moveItBox(const std::string& id, double x, double size);
/// Our message, written and read by MoveIt.
moveit_msgs::PlanningScene asMoveItMessage(const PlanningSceneMessage& scene);
}  // namespace gpu_planning_scene::core
