#pragma once

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// The box along the axes of its frame that holds a shape, which is no half-space.
Eigen::AlignedBox3d boundsOf(const Shape& shape);
}  // namespace gpu_planning_scene::core
