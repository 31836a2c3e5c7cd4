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
/// and has the opposite direction. `uses` are those of the triangles that count. `cycles`: a number for each triangle;
/// the triangles with one number have no signed boundary, and are never of one shell with others. Corners are indices
/// into `points`.
std::vector<std::uint32_t> trianglesToTurn(const std::vector<Eigen::Vector3d>& points,
                                           const std::vector<Corners>& triangles, const std::vector<EdgeUse>& uses,
                                           const std::vector<std::uint32_t>& cycles);
}  // namespace gpu_planning_scene::core
