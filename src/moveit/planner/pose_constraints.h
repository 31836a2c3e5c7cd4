#pragma once

#include <string>

#include <moveit/planning_scene/planning_scene.h>
#include <moveit/robot_state/robot_state.h>
#include <moveit_msgs/Constraints.h>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "moveit/planner/robot_conversion.h"

namespace gpu_planning_scene::pipeline
{
/// MoveIt's constraints for the converted robot: joint, position and orientation constraints. `start`: where frames and
/// attached objects are. `group`: its joints will move. `code`: of a Refusal that the constraints themselves cause.
/// `where`: begins its message. Throws Refusal for a constraint that is not valid, for visibility constraints, for an
/// unknown frame or link, and for a frame that the group moves.
core::KinematicConstraints kinematicConstraints(const moveit_msgs::Constraints& message,
                                                const planning_scene::PlanningScene& scene,
                                                const moveit::core::RobotState& start,
                                                const moveit::core::JointModelGroup& group,
                                                const RobotConversion& robot, std::int32_t code,
                                                const std::string& where);
}  // namespace gpu_planning_scene::pipeline
