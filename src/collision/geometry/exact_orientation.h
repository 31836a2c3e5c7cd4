#pragma once

#include <Eigen/Core>

namespace gpu_planning_scene::core
{
/// On which side of the plane through a, b and c the point d lies: the sign of (b - a) x (c - a) . (d - a), exactly,
/// for any finite doubles.
int exactOrientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d);
}  // namespace gpu_planning_scene::core
