#pragma once

#include <vector>

#include <Eigen/Core>

#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
/// Closes seams with T-junctions: along one side of a seam an edge ends where the other side's edge goes on. For each
/// edge that an odd number of the triangles use, and that passes within `tolerance` (metres) of the ends of other such
/// edges, the function returns the thin triangles between the edge and these ends. They lie beside the edge's triangle,
/// in the opposite direction along the edge. Corners are indices into `points`.
std::vector<Corners> seamTriangles(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles,
                                   double tolerance);
}  // namespace gpu_planning_scene::core
