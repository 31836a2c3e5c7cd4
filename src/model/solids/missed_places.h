#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
/// Counts places that triangles seem to enclose, but at which the winding number of `cycle` is 0. Such a place is in a
/// chamber that `cycle` misses, in a cavity, or in a deep pocket. Looks at both sides of the largest triangle of each
/// patch; in large meshes, only of the patches with the largest triangles. Corners are indices into `points`.
std::size_t countMissedPlaces(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles,
                              const std::vector<Corners>& cycle);
}  // namespace gpu_planning_scene::core
