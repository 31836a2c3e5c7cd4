#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
/// How a triangle belongs to the largest closed surface among given triangles.
enum class CorePlace : std::uint8_t
{
  Core,   ///< a triangle of this surface
  Wall,   ///< of a wall that this surface contains
  Beside  ///< of a sheet with free edges, for example a fin
};

/// Takes away the triangles at free edges until none is left, for example a fin. Then chooses, among the patches that
/// are left, those that have an even number of triangles at each edge and contain the largest volume; the others are
/// walls in it. All triangles are Beside if no surface is closed. The triangles must have distinct corners.
std::vector<CorePlace> closedCore(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles);
}  // namespace gpu_planning_scene::core
