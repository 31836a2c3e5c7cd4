#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_forest.h"

namespace gpu_planning_scene::core
{
/// Whether a point, in the frame of the mesh, is inside the solid that the closed components bound, i.e. whether their
/// winding number around the point is not 0 (Jacobson et al. 2013). The answer is exact for points that are not on a
/// triangle of a closed component. `stack` is work space.
bool isInsideSolid(const CpuTree& tree, const Eigen::Vector3d& point, std::vector<std::uint32_t>& stack);
}  // namespace gpu_planning_scene::core
