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
Eigen::Isometry3d toIsometry(const urdf::Pose& pose, const std::string& where);

/// The collision elements of a link, in its frame. `where` is the link's place in the URDF.
std::vector<PlacedShape> collisionShapes(const urdf::Link& link, const std::string& where,
                                         const RobotModelOptions& options, MeshCache& meshes);
}  // namespace gpu_planning_scene::core
