#pragma once

#include <Eigen/Core>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "model/inverse_kinematics/kinematic_chains.h"

namespace gpu_planning_scene::core
{
/// The equations of one step towards a state that fulfils constraints: one row for each number that is outside its
/// tolerance. Numbers within their tolerance have no row, so they may change freely. Not thread-safe.
class ConstraintRows
{
 public:
  ConstraintRows(const KinematicConstraints& constraints, const KinematicChains& chains);
  ~ConstraintRows();  // in the library, which allocates the rows: code with sanitizers has another allocator of Eigen
  ConstraintRows(const ConstraintRows&) = delete;
  ConstraintRows& operator=(const ConstraintRows&) = delete;

  /// Computes the rows for the poses in the workspace. They aim at the tolerances times `share` (0 to 1). Returns true
  /// if the positions and orientations are within their whole tolerances.
  bool compute(const KinematicChains::Workspace& workspace, double share);

  /// The changes that the rows ask for (metres, radians).
  auto errors() const { return errors_.head(count_); }
  /// The derivatives of the numbers with respect to the degrees of freedom.
  auto derivatives() { return derivatives_.topRows(count_); }

 private:
  bool add(const PositionConstraint& constraint, const KinematicChains::Workspace& workspace, double share);
  bool add(const OrientationConstraint& constraint, const KinematicChains::Workspace& workspace, double share);
  void useLink(int link, const KinematicChains::Workspace& workspace);

  const KinematicConstraints& constraints_;
  const KinematicChains& chains_;
  Eigen::VectorXd errors_;
  Eigen::MatrixXd derivatives_;
  Eigen::Index count_ = 0;
  KinematicChains::Jacobian jacobian_;  // of the link below
  int link_ = -1;
};
}  // namespace gpu_planning_scene::core
