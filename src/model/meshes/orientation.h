#pragma once

#include <Eigen/Core>

namespace gpu_planning_scene::core
{
/// 1 if a, b, c turn counterclockwise, -1 if they turn clockwise, 0 if they lie on a line. Exact for finite doubles of
/// magnitude below 1e150.
int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);
}  // namespace gpu_planning_scene::core
