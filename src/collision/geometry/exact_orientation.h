#pragma once

#include <Eigen/Core>

namespace gpu_planning_scene::core
{
/// The side of the plane through a, b and c on which d lies: the sign of (b - a) x (c - a) . (d - a). The sign is exact
/// for all finite doubles.
int exactOrientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d);
}  // namespace gpu_planning_scene::core
