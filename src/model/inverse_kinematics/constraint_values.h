#pragma once

#include <Eigen/Geometry>

#include "gpu_planning_scene/kinematic_constraints.h"

namespace gpu_planning_scene::core
{
/// The constrained point in the frame of its region, for a pose of the link.
Eigen::Vector3d localPoint(const PositionConstraint& constraint, const Eigen::Isometry3d& link);

/// The point of the region that is nearest to a local point. The region is shrunk by the factor `share` (0 to 1) about
/// its centre.
Eigen::Vector3d nearestInRegion(const PositionConstraint& constraint, const Eigen::Vector3d& local, double share);

/// The three numbers of an orientation constraint for a pose of the link, and their derivatives.
struct OrientationValues
{
  Eigen::Vector3d angles;  ///< radians, each from -pi to pi
  Eigen::Matrix3d rates;   ///< rates of the angles = rates * angular velocity of the link in the planning frame
};
OrientationValues orientationValues(const OrientationConstraint& constraint, const Eigen::Isometry3d& link);
}  // namespace gpu_planning_scene::core
