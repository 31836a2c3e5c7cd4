#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
// Conversions of numbers that MoveIt's messages and scene files share. They throw Error for values that have no
// meaning.

/// Numbered as in shape_msgs/SolidPrimitive.
enum class PrimitiveType
{
  Box = 1,
  Sphere = 2,
  Cylinder = 3,
  Cone = 4
};

/// The dimensions are x, y, z for a box, the radius for a sphere, and height, radius for a cylinder and a cone. Zeros
/// may follow, because some clients fill in more numbers than needed. The sizes are not checked here: see
/// validateShape.
Shape primitiveOf(PrimitiveType type, const std::vector<double>& dimensions);

/// The half-space behind the plane a x + b y + c z + d = 0.
HalfSpace halfSpaceBehind(const Eigen::Vector4d& plane);

/// The values of a planar or floating joint's variables for which its child is at `pose` in the joint's frame: the
/// frame of the parent link, moved by the joint's origin.
std::vector<double> variablesAt(const Joint& joint, const Eigen::Isometry3d& pose);
/// The inverse of variablesAt. The quaternion must not have length 0.
Eigen::Isometry3d poseOfVariables(const Joint& joint, const double* values);
}  // namespace gpu_planning_scene::core
