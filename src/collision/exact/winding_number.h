#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/trees/cpu_forest.h"

namespace gpu_planning_scene::core
{
/// Whether a point, in the frame of the mesh, is inside the solid of the mesh: the winding number of its triangles
/// around the point is not 0, or a ray crosses an odd number of the triangles that count by parity (see TriangleRole).
/// The answer is exact for points that are not on a triangle that counts for the solid. `stack` is work space.
bool isInsideSolid(const CpuTree& tree, const Eigen::Vector3d& point, std::vector<std::uint32_t>& stack);
}  // namespace gpu_planning_scene::core
