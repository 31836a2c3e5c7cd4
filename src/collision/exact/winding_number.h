#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_forest.h"

namespace gpu_planning_scene::core
{
/// Whether the point, in the frame of a mesh, is inside the solid that the closed components of the mesh bound: whether
/// their winding number around it is not 0. Exact for a point that is not on a triangle of a closed component. `stack`
/// is work space.
bool isInsideSolid(const CpuTree& tree, const Eigen::Vector3d& point, std::vector<std::uint32_t>& stack);
}  // namespace gpu_planning_scene::core
