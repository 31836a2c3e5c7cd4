#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <moveit/robot_model/robot_model.h>
#include <moveit/robot_state/robot_state.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::pipeline
{
/// The properties of the converted robot that differ between requests. Requests with equal needs share a robot.
struct RobotNeeds
{
  /// Mimic joints whose value in the start state differs from the value that their leader gives. Each becomes a joint
  /// of its own; the value is within its limits. Real grippers report such values.
  std::map<std::string, double> own_values;
  /// Links with a second link, see RobotConversion::carrier.
  std::set<std::string> carriers;
  /// Scale of the links whose scale is not 1, see RobotConversion::scaledLink.
  std::map<std::string, double> scales;
  /// Range of the translations of planar and floating joints without limits, in metres.
  std::optional<Eigen::AlignedBox3d> workspace;
};

/// A robot of MoveIt as a robot of this package: the same kinematics, limits, groups and collision shapes. The pairs
/// that the SRDF allows are not converted, because a scene of MoveIt has them in its matrix. Immutable and thread-safe.
class RobotConversion
{
 public:
  /// Throws core::Error if the robot cannot be expressed exactly.
  RobotConversion(const moveit::core::RobotModelConstPtr& model, const RobotNeeds& needs);

  const std::shared_ptr<const core::RobotModel>& robot() const { return robot_; }

  /// Index of a link. The converted robot has the links of MoveIt's robot in the same order, then those of carrier()
  /// and scaledLink().
  static int link(const moveit::core::LinkModel& link) { return link.getLinkIndex(); }
  /// Index of the link to which the bodies that `link` carries are attached. For the links of RobotNeeds::carriers, it
  /// is a second link without shapes at the same place: this package does not check an attached object against its own
  /// link, while MoveIt does.
  int carrier(const moveit::core::LinkModel& link) const;

  /// Index of a second link with the scaled shapes of `link`, at the same place; no value if the scale is 1. MoveIt
  /// scales links for the check with the world, but not for the check with other links.
  std::optional<int> scaledLink(const moveit::core::LinkModel& link) const;

  /// A row of all variables of the converted robot.
  std::vector<double> row(const moveit::core::RobotState& state) const;
  /// Sets all variables of the state, also those of mimic joints.
  void setVariables(const double* row, moveit::core::RobotState& state) const;
  /// How a variable of MoveIt's robot follows from a converted one: multiplier * value + offset. The variable of a
  /// mimic joint follows from that of its leader, every other one is equal to a converted one.
  struct MoveitVariable
  {
    int index = -1;
    double multiplier = 1.0;
    double offset = 0.0;
    bool mimic = false;
  };
  /// `index`: of MoveIt's variable.
  const MoveitVariable& variable(std::size_t index) const { return variables_[index]; }

  const RobotNeeds& needs() const { return needs_; }
  /// Whether the conversion fits a robot and a request.
  bool serves(const moveit::core::RobotModelConstPtr& model, const RobotNeeds& needs) const;

 private:
  moveit::core::RobotModelConstPtr model_;
  RobotNeeds needs_;
  std::shared_ptr<const core::RobotModel> robot_;
  std::vector<MoveitVariable> variables_;  // by their index in MoveIt's robot
  std::map<std::string, int> carriers_;    // link indices, by the name of the carrying link
  std::map<std::string, int> scaled_;      // link indices, by the name of the link
};

/// Whether a variable has two limits. MoveIt's planar and floating joints have infinite limits if nothing else is set.
bool hasLimits(const moveit::core::VariableBounds& bounds);

/// The mimic joints of a state whose value differs from the value that their leader gives, and these values.
std::map<std::string, double> ownMimicValues(const moveit::core::RobotState& state);

/// Throws Refusal if joints of the group move between two states in another manner than the planner assumes.
void requirePlannable(const moveit::core::JointModelGroup& group);
}  // namespace gpu_planning_scene::pipeline
