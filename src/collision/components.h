#pragma once

#include <cstddef>
#include <vector>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene
{
/// One vertex of each connected component of a mesh, equal vertices welded; empty if there are more than `limit`.
/// A component that meets no surface of a solid lies inside it exactly where any of its points does.
std::vector<Eigen::Vector3d> componentPoints(const Mesh& mesh, std::size_t limit);
}  // namespace gpu_planning_scene
