#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/inverse_kinematics.h"

namespace gpu_planning_scene::core
{
/// Constraints that a whole path must fulfil. Immutable and thread-safe. Rows have one value per variable of the robot.
class PathConstraints
{
 public:
  /// Throws the errors of InverseKinematics.
  PathConstraints(std::shared_ptr<const RobotModel> robot, const std::string& group, KinematicConstraints constraints)
    : robot_(robot), kinematics_(std::move(robot), group, std::move(constraints))
  {
  }

  const KinematicConstraints& constraints() const { return kinematics_.constraints(); }
  ConstraintViolation violation(const double* state) const { return kinematics_.violation(state); }

  /// Moves a state to a near one that fulfils the constraints. Returns false if there is none near it.
  bool project(double* state) const { return kinematics_.project(state); }

  /// True if the straight motion between two states is proven to fulfil the constraints: the slack of each sample is
  /// larger than the displacements of links and points up to the next sample. A motion that almost reaches the end of a
  /// tolerance gets false.
  bool holdAlong(const double* from, const double* to) const;

 private:
  std::shared_ptr<const RobotModel> robot_;
  InverseKinematics kinematics_;
};
}  // namespace gpu_planning_scene::core
