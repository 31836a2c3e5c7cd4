#pragma once

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Whether a point in the shape's frame is inside the shape. A point is inside a mesh if most of several rays from it
/// cross the triangles an odd number of times; for an open mesh this means little. Brute force, independent of the
/// tested code.
bool isInside(const Shape& shape, const Eigen::Vector3d& point);

/// Whether a mesh at `pose` in the shape's frame has a vertex inside the shape.
bool hasVertexInside(const Mesh& mesh, const Eigen::Isometry3d& pose, const Shape& shape);
}  // namespace gpu_planning_scene::core
