#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include <moveit_msgs/Constraints.h>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "moveit/planner/robot_conversion.h"

namespace gpu_planning_scene::pipeline
{
/// A goal of joint constraints: the states whose variables are within ranges. The variables of the group that no
/// constraint names may have any value within their limits.
class GoalRegion
{
 public:
  /// `start`: a row of all variables. Throws Refusal if a constraint is not valid, names a joint that the group does
  /// not move and whose value in the start violates it, or contradicts the limits or another constraint.
  GoalRegion(const moveit_msgs::Constraints& constraints, const moveit::core::RobotModel& model,
             const RobotConversion& robot, const core::GroupStateSpace& space, const std::vector<double>& start);

  /// Whether a range is so wide that its middle does not stand for the whole region.
  bool isWide() const;

  /// The state at the constraints' positions; variables without a constraint have their value in the start.
  const std::vector<double>& middle() const { return middle_; }
  /// A random state of the region, uniform in each variable. Rotations of floating joints stay as in middle().
  std::vector<double> sample(std::mt19937_64& random) const;

 private:
  struct Range
  {
    int variable;
    double lower;
    double upper;
    bool sampled;
  };

  std::vector<double> middle_;
  std::vector<Range> ranges_;  // of the group's variables
};

/// Adds the ranges of joint constraints to `ranges`. Throws Refusal if a constraint is not valid.
void addJointRanges(const moveit_msgs::Constraints& constraints, const moveit::core::RobotModel& model,
                    const RobotConversion& robot, core::KinematicConstraints& ranges);

/// Whether the constraints are joint constraints only, at least one.
bool isJointGoal(const moveit_msgs::Constraints& constraints);
}  // namespace gpu_planning_scene::pipeline
