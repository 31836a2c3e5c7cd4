#pragma once

#include <limits>

#include <Eigen/Core>

#include "model/inverse_kinematics/constraint_rows.h"
#include "model/inverse_kinematics/kinematic_chains.h"

namespace gpu_planning_scene::core
{
/// Moves a state until links fulfil constraints: damped least squares with limits. Not thread-safe, because it keeps
/// its buffers between calls.
class Descent
{
 public:
  /// `freedoms`: those of the chains, with narrower limits. The arguments must outlive this object.
  Descent(const KinematicConstraints& constraints, const KinematicChains& chains, const DegreesOfFreedom& freedoms)
    : chains_(chains), freedoms_(freedoms), rows_(constraints, chains)
  {
  }

  /// True: `state` fulfils the constraints. False: the descent ended elsewhere. `share`: the descent aims at the
  /// tolerances times this factor.
  bool run(double* state, double share);

  /// The squared error at the end of the last descent.
  double squaredError() const { return squared_error_; }

 private:
  void computeStep(const double* state);

  const KinematicChains& chains_;
  const DegreesOfFreedom& freedoms_;
  ConstraintRows rows_;
  KinematicChains::Workspace workspace_;
  Eigen::VectorXd step_;
  Eigen::VectorXd rest_;
  Eigen::MatrixXd matrix_;
  double squared_error_ = std::numeric_limits<double>::infinity();
};
}  // namespace gpu_planning_scene::core
