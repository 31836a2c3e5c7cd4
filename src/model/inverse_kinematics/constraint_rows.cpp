#include "model/inverse_kinematics/constraint_rows.h"

#include <algorithm>
#include <cmath>

#include "model/inverse_kinematics/constraint_values.h"

namespace gpu_planning_scene::core
{
ConstraintRows::ConstraintRows(const KinematicConstraints& constraints, const KinematicChains& chains)
  : constraints_(constraints), chains_(chains)
{
  const auto rows = static_cast<Eigen::Index>(3 * (constraints.positions.size() + constraints.orientations.size()));
  errors_.resize(rows);
  derivatives_.resize(rows, static_cast<Eigen::Index>(chains.degreesOfFreedom().size()));
}

ConstraintRows::~ConstraintRows() = default;

bool ConstraintRows::compute(const KinematicChains::Workspace& workspace, double share)
{
  count_ = 0;
  link_ = -1;
  bool is_within = true;
  for (const PositionConstraint& constraint : constraints_.positions)
    is_within = add(constraint, workspace, share) && is_within;
  for (const OrientationConstraint& constraint : constraints_.orientations)
    is_within = add(constraint, workspace, share) && is_within;
  return is_within;
}

void ConstraintRows::useLink(int link, const KinematicChains::Workspace& workspace)
{
  if (link == link_)
    return;
  chains_.jacobian(link, workspace, jacobian_);
  link_ = link;
}

bool ConstraintRows::add(const PositionConstraint& constraint, const KinematicChains::Workspace& workspace,
                         double share)
{
  const Eigen::Isometry3d& link = workspace.poses[static_cast<std::size_t>(constraint.link)];
  const Eigen::Vector3d local = localPoint(constraint, link);
  const Eigen::Vector3d error = nearestInRegion(constraint, local, share) - local;
  if (error.isZero(0.0))
    return true;
  useLink(constraint.link, workspace);
  const Eigen::Vector3d arm = link.linear() * constraint.point;
  const bool is_sphere = std::holds_alternative<Sphere>(constraint.region);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (error[axis] == 0.0 && !is_sphere)
      continue;
    const Eigen::Vector3d direction = constraint.pose.linear().col(axis);
    errors_[count_] = error[axis];
    derivatives_.row(count_).noalias() = direction.transpose() * jacobian_.topRows<3>();
    derivatives_.row(count_).noalias() += arm.cross(direction).transpose() * jacobian_.bottomRows<3>();
    ++count_;
  }
  return nearestInRegion(constraint, local, 1.0) == local;
}

bool ConstraintRows::add(const OrientationConstraint& constraint, const KinematicChains::Workspace& workspace,
                         double share)
{
  const OrientationValues values =
      orientationValues(constraint, workspace.poses[static_cast<std::size_t>(constraint.link)]);
  bool is_within = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double angle = values.angles[axis];
    const double aim = share * constraint.tolerance[axis];
    if (std::abs(angle) <= aim || constraint.tolerance[axis] >= M_PI)
      continue;
    useLink(constraint.link, workspace);
    is_within = is_within && std::abs(angle) <= constraint.tolerance[axis];
    errors_[count_] = std::copysign(aim, angle) - angle;
    derivatives_.row(count_).noalias() = values.rates.row(axis) * jacobian_.bottomRows<3>();
    ++count_;
  }
  return is_within;
}
}  // namespace gpu_planning_scene::core
