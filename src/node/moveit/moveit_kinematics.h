#pragma once

#include <moveit_msgs/GetCartesianPath.h>
#include <moveit_msgs/GetPositionFK.h>
#include <moveit_msgs/GetPositionIK.h>

#include "node/kinematics/kinematics_services.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Answers MoveIt's services compute_ik, compute_fk and compute_cartesian_path: it turns their requests into those of
/// KinematicsServices. Throws nothing: the response has MoveIt's error code, and the log has the reason. Thread-safe.
class MoveItKinematics
{
 public:
  /// The arguments must outlive this object.
  MoveItKinematics(const SceneStore& store, KinematicsServices& kinematics) : store_(store), kinematics_(kinematics) {}

  /// The pose is reached within 1e-6 m and rad. `timeout` is not read: a search ends after 200 attempts, in some
  /// milliseconds. Requests with constraints or with several links are refused.
  moveit_msgs::GetPositionIK::Response ik(const moveit_msgs::GetPositionIK::Request& request) const;

  moveit_msgs::GetPositionFK::Response fk(const moveit_msgs::GetPositionFK::Request& request) const;

  /// The trajectory has times, for the whole limits of the joints. The jump bound is the smaller one of
  /// revolute_jump_threshold and prismatic_jump_threshold, or that of ComputeCartesianPath.srv. jump_threshold is not
  /// read, because the path cannot jump. A request with max_cartesian_speed is refused.
  moveit_msgs::GetCartesianPath::Response lines(const moveit_msgs::GetCartesianPath::Request& request) const;

 private:
  PlanningSceneMessage changeOf(const moveit_msgs::RobotState& state) const;
  void requireGroup(const std::string& group) const;

  const SceneStore& store_;
  KinematicsServices& kinematics_;
};
}  // namespace gpu_planning_scene::core
