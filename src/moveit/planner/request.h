#pragma once

#include <optional>

#include <moveit/planning_interface/planning_request.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/robot_state/robot_state.h>
#include <Eigen/Geometry>

namespace gpu_planning_scene::pipeline
{
/// Throws Refusal for a request that the planner does not plan: an unknown group, trajectory or visibility constraints,
/// no goal.
void requireSupported(const planning_interface::MotionPlanRequest& request, const moveit::core::RobotModel& model);

/// The start state of a request: the scene's current state, changed by `request.start_state`. Throws Refusal if a part
/// of the start state cannot be used.
moveit::core::RobotState startOf(const planning_interface::MotionPlanRequest& request,
                                 const planning_scene::PlanningScene& scene);

/// The range of the translations of the group's planar and floating joints, in metres; no value if the request needs
/// none. As in MoveIt's OMPL interface, the corners of the workspace are ranges of the joints' variables. Throws
/// Refusal if a range is missing or not valid, or if its frame is rotated or unknown.
std::optional<Eigen::AlignedBox3d> workspaceOf(const planning_interface::MotionPlanRequest& request,
                                               const planning_scene::PlanningScene& scene,
                                               const moveit::core::JointModelGroup& group);
}  // namespace gpu_planning_scene::pipeline
