#pragma once

#include <Eigen/Core>

#include "gpu_planning_scene/solids.h"

namespace gpu_planning_scene::core
{
/// Whether a point that is not on the surface is inside the solid, by brute force over the triangles that count.
/// Expects that these are closed.
bool contains(const SolidMesh& solid, const Eigen::Vector3d& point);
}  // namespace gpu_planning_scene::core
