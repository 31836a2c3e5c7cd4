#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
/// Counts places that `triangles` seem to enclose but that are not inside by the winding number of `chain`: the
/// opening of a cavity is not seen, or a chamber is missed. Places beside the largest triangles of each patch are
/// looked at. Corners are indices into `points`.
std::size_t hiddenChambers(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles,
                           const std::vector<Corners>& chain);
}  // namespace gpu_planning_scene::core
