#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include <geometric_shapes/shapes.h>
#include <gtest/gtest.h>
#include <moveit/kinematic_constraints/utils.h>
#include <moveit/planning_interface/planning_interface.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/utils/robot_model_test_utils.h>
#include <pluginlib/class_loader.hpp>

#include "moveit/shapes.h"

namespace gpu_planning_scene::pipeline
{
inline planning_interface::PlannerManagerPtr loadManager(const moveit::core::RobotModelConstPtr& robot)
{
  static pluginlib::ClassLoader<planning_interface::PlannerManager> loader("moveit_core",
                                                                           "planning_interface::PlannerManager");
  planning_interface::PlannerManagerPtr manager = loader.createUniqueInstance("gpu_planning_scene/PlannerManager");
  if (!manager->initialize(robot, "planner_test"))
    throw std::runtime_error("the planner manager cannot be initialised");
  return manager;
}

/// A cart that drives on a floor, from the origin to a goal behind a wall.
class Cart : public testing::Test
{
 protected:
  Cart() : robot_(makeRobot()), scene_(std::make_shared<planning_scene::PlanningScene>(robot_))
  {
    scene_->getCurrentStateNonConst().setToDefaultValues();
    scene_->getCurrentStateNonConst().update();
    moveit::core::RobotState goal = scene_->getCurrentState();
    goal.setVariablePosition("drive/x", 4.0);
    goal.update();
    request_.group_name = "cart";
    request_.allowed_planning_time = 20.0;
    request_.goal_constraints.push_back(
        kinematic_constraints::constructGoalConstraints(goal, robot_->getJointModelGroup("cart"), 1e-3));
    setWorkspace(5.0);
    manager_ = loadManager(robot_);
  }

  static moveit::core::RobotModelPtr makeRobot()
  {
    moveit::core::RobotModelBuilder builder("cart", "base");
    geometry_msgs::Pose pose;
    pose.orientation.w = 1.0;
    builder.addCollisionBox("base", {0.4, 0.4, 0.4}, pose);
    builder.addVirtualJoint("world", "base", "planar", "drive");
    builder.addGroup({}, {"drive"}, "cart");
    return builder.build();
  }

  void setWorkspace(double reach)
  {
    request_.workspace_parameters.min_corner.x = request_.workspace_parameters.min_corner.y = -reach;
    request_.workspace_parameters.max_corner.x = request_.workspace_parameters.max_corner.y = reach;
  }

  void addWall(double length)
  {
    scene_->getWorldNonConst()->addToObject("wall", at(2.0, 0.0, 0.0), box(0.2, length, 1.0),
                                            Eigen::Isometry3d::Identity());
  }

  int plan()
  {
    moveit_msgs::MoveItErrorCodes code;
    const planning_interface::PlanningContextPtr context = manager_->getPlanningContext(scene_, request_, code);
    if (!context)
      return code.val;
    context->solve(response_);
    return response_.error_code_.val;
  }

  moveit::core::RobotModelPtr robot_;
  planning_scene::PlanningScenePtr scene_;
  planning_interface::PlannerManagerPtr manager_;
  planning_interface::MotionPlanRequest request_;
  planning_interface::MotionPlanResponse response_;
};
}  // namespace gpu_planning_scene::pipeline
