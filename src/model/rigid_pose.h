#pragma once

#include <string>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// Returns true if nearestRigid() accepts the pose.
bool isRigid(const Eigen::Isometry3d& pose);

/// The pose with the rotation that is nearest to its matrix. Later computations use the transpose of a rotation as its
/// inverse, and poses from single precision or from long products are off by some digits. Throws Error that begins with
/// `where` if the pose is not finite, off by more than 1e-6, or farther than 1000 km away.
Eigen::Isometry3d nearestRigid(const Eigen::Isometry3d& pose, const std::string& where);

/// The pose of a shape: the product of the pose of its body and its pose in the body's frame. The validation of the
/// scene has accepted both. All code that needs the place of a shape calls this function, because a small
/// error of a rotation displaces a distant shape by a large length.
Eigen::Isometry3d rigidProduct(const Eigen::Isometry3d& body, const Eigen::Isometry3d& shape);
}  // namespace gpu_planning_scene::core
