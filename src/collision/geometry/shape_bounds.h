#pragma once

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// The axis-aligned bounding box of a shape in the shape's frame. The shape must not be a half-space.
Eigen::AlignedBox3d boundsOf(const Shape& shape);
}  // namespace gpu_planning_scene::core
