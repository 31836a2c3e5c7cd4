#pragma once

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene
{
/// Whether two solids, each a cylinder or a cone, come within 1e-6 m of each other, `b` placed in the frame of `a`: the
/// accuracy of FCL's distance (GJK, by libccd), which decides. For pairs that are known to be close: it is slow.
bool curvedSolidsMeet(const Shape& a, const Shape& b, const Eigen::Isometry3d& b_in_a);
}  // namespace gpu_planning_scene
