#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
// What the numbers of MoveIt's messages mean, in messages and in files. All throw Error.

/// Numbered as in shape_msgs/SolidPrimitive.
enum class PrimitiveType
{
  Box = 1,
  Sphere = 2,
  Cylinder = 3,
  Cone = 4
};

/// Box: x, y, z; sphere: radius; cylinder and cone: height, radius. Zeros may follow, as messages that were filled by
/// habit have them. The sizes are not looked at: see validateShape.
Shape primitiveOf(PrimitiveType type, const std::vector<double>& dimensions);

/// The half-space behind the plane a x + b y + c z + d = 0.
HalfSpace halfSpaceBehind(const Eigen::Vector4d& plane);

/// The values of a planar or floating joint's variables where its child is at `pose` in the joint's frame.
std::vector<double> variablesAt(const Joint& joint, const Eigen::Isometry3d& pose);
/// The opposite. Not for a quaternion of zero length.
Eigen::Isometry3d poseOfVariables(const Joint& joint, const double* values);
}  // namespace gpu_planning_scene::core
