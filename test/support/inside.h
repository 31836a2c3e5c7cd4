#pragma once

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Whether a point in the shape's frame is inside it. Of a mesh: whether most of several rays from the point cross its
/// triangles an odd number of times, which means little for an open one. By brute force, independent of the code that
/// it tests.
bool isInside(const Shape& shape, const Eigen::Vector3d& point);

/// Whether a mesh at `pose` in the shape's frame has a vertex inside the shape.
bool hasVertexInside(const Mesh& mesh, const Eigen::Isometry3d& pose, const Shape& shape);
}  // namespace gpu_planning_scene::core
