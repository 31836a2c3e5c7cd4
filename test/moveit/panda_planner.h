#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <moveit/kinematic_constraints/kinematic_constraint.h>

#include "moveit/moveit_resources.h"
#include "moveit/planner_fixtures.h"

namespace gpu_planning_scene::pipeline
{
constexpr char kArm[] = "panda_arm";
inline const std::set<std::string> kHandLinks = {"panda_hand", "panda_leftfinger", "panda_rightfinger"};

inline const bool kPluginsAreFound = (useBuiltPlugins(), true);

/// MoveIt's panda with this package's planner. Paths are checked with MoveIt's FCL detector.
class Planner : public testing::Test
{
 protected:
  Planner() : scene_(std::make_shared<planning_scene::PlanningScene>(robot())), start_(robot()), goal_(robot())
  {
    start_.setToDefaultValues();
    start_.setJointGroupPositions(kArm, std::vector<double>{-1.2, -0.3, 0.0, -2.0, 0.0, 1.7, 0.8});
    start_.update();
    goal_ = start_;
    goal_.setJointGroupPositions(kArm, std::vector<double>{1.2, -0.3, 0.0, -2.0, 0.0, 1.7, 0.8});
    goal_.update();
    scene_->setCurrentState(start_);
  }

  static const moveit::core::RobotModelPtr& robot()
  {
    static const moveit::core::RobotModelPtr model = moveit::core::loadTestingRobotModel("panda");
    return model;
  }

  static planning_interface::PlannerManager& manager()
  {
    static const planning_interface::PlannerManagerPtr manager = loadManager(robot());
    return *manager;
  }

  /// A request from the scene's current state to goal_.
  planning_interface::MotionPlanRequest request(const moveit::core::RobotState& goal, double tolerance = 1e-4) const
  {
    planning_interface::MotionPlanRequest request;
    request.group_name = kArm;
    request.allowed_planning_time = 20.0;
    request.num_planning_attempts = 1;
    request.start_state.is_diff = true;
    request.goal_constraints.push_back(
        kinematic_constraints::constructGoalConstraints(goal, robot()->getJointModelGroup(kArm), tolerance));
    return request;
  }

  int plan(const planning_interface::MotionPlanRequest& request, planning_interface::MotionPlanResponse& response) const
  {
    moveit_msgs::MoveItErrorCodes code;
    const planning_interface::PlanningContextPtr context = manager().getPlanningContext(scene_, request, code);
    if (!context)
      return code.val;
    const bool solved = context->solve(response);
    EXPECT_EQ(solved, response.error_code_.val == moveit_msgs::MoveItErrorCodes::SUCCESS);
    EXPECT_EQ(solved, response.trajectory_ != nullptr);
    return response.error_code_.val;
  }

  int plan(const planning_interface::MotionPlanRequest& request) const
  {
    planning_interface::MotionPlanResponse response;
    return plan(request, response);
  }

  bool collides(const moveit::core::RobotState& state) const { return scene_->isStateColliding(state, kArm); }

  /// The number of states of a path that collide: 100 in each motion between two waypoints.
  int collidingStates(const robot_trajectory::RobotTrajectory& path) const
  {
    int count = 0;
    moveit::core::RobotState state = path.getFirstWayPoint();
    for (std::size_t i = 1; i < path.getWayPointCount(); ++i)
      for (int k = 0; k <= 100; ++k)
      {
        path.getWayPoint(i - 1).interpolate(path.getWayPoint(i), 0.01 * k, state);
        state.update();
        count += collides(state) ? 1 : 0;
      }
    return count;
  }

  bool fulfils(const moveit::core::RobotState& state, const moveit_msgs::Constraints& goal) const
  {
    kinematic_constraints::KinematicConstraintSet constraints(robot());
    constraints.add(goal, scene_->getTransforms());
    return constraints.decide(state).satisfied;
  }

  void addObject(const std::string& name, const shapes::ShapeConstPtr& shape, const Eigen::Isometry3d& pose)
  {
    scene_->getWorldNonConst()->addToObject(name, pose, shape, Eigen::Isometry3d::Identity());
  }

  /// A post in front of the robot, between start and goal.
  void addPost() { addObject("post", box(0.1, 0.1, 1.6), at(0.5, 0.0, 0.8)); }

  /// A box at the hand in the goal.
  void addBoxInGoal() { addObject("box", box(0.1, 0.1, 0.1), goal_.getGlobalLinkTransform("panda_hand")); }

  void attachBox(const std::set<std::string>& touch_links, const Eigen::Vector3d& size, const Eigen::Isometry3d& pose)
  {
    moveit::core::RobotState& state = scene_->getCurrentStateNonConst();
    state.attachBody("tool", pose, {box(size.x(), size.y(), size.z())}, {Eigen::Isometry3d::Identity()}, touch_links,
                     "panda_hand");
    state.update();
  }

  planning_scene::PlanningScenePtr scene_;
  moveit::core::RobotState start_;
  moveit::core::RobotState goal_;
};
}  // namespace gpu_planning_scene::pipeline
