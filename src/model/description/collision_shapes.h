#pragma once

#include <string>
#include <vector>

#include <urdf_model/types.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/resources.h"
#include "gpu_planning_scene/robot_model.h"

namespace urdf
{
class Link;
class Pose;
}  // namespace urdf

namespace gpu_planning_scene::core
{
/// The pose as an isometry, with its quaternion normalised. Throws Error that begins with `where` if the translation is
/// not finite or beyond kLargestLength.
Eigen::Isometry3d toIsometry(const urdf::Pose& pose, const std::string& where);

/// The shapes of a link's collision elements, with poses in the link's frame. `where`: place of the link in the URDF,
/// for messages. A shape of size 0, which is a point, is left out. A flat primitive gets a thickness, see thicken().
/// Both get a line in `warnings`. Throws Error.
std::vector<PlacedShape> collisionShapes(const urdf::Link& link, const std::string& where,
                                         const RobotModelOptions& options, MeshCache& meshes,
                                         std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
