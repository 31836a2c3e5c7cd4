#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
/// A shell is a closed surface that no edge joins to another one. Returns the numbers of the triangles to turn, so that
/// shells of opposite directions do not cancel where they overlap: the winding number is above 0 inside each shell,
/// except in a cavity. A cavity is a shell that lies entirely within the solid of another shell, without touching it,
/// and has the opposite direction. `uses` are those of the triangles that count, which have no signed boundary. Corners
/// are indices into `points`.
std::vector<std::uint32_t> trianglesToTurn(const std::vector<Eigen::Vector3d>& points,
                                           const std::vector<Corners>& triangles, const std::vector<EdgeUse>& uses);
}  // namespace gpu_planning_scene::core
