#pragma once

#include <string>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// Whether `rigid` takes the pose.
bool isRigid(const Eigen::Isometry3d& pose);

/// The pose with the rotation that is nearest to its matrix: all that follows takes a rotation's transpose for its
/// inverse. Poses that come from single precision or from long products are off by some digits. Throws Error that
/// begins with `where` if the pose is not finite, or off by more than 1e-6.
Eigen::Isometry3d rigid(const Eigen::Isometry3d& pose, const std::string& where);

/// The pose of a shape whose pose in a body's frame is `shape`; the scene's validation has seen both. All that asks
/// where a shape is takes it from here: how far a rotation that is a little off moves a shape grows with the distance.
Eigen::Isometry3d rigidProduct(const Eigen::Isometry3d& body, const Eigen::Isometry3d& shape);
}  // namespace gpu_planning_scene::core
