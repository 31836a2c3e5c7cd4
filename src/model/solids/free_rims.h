#pragma once

#include <vector>

#include <Eigen/Core>

#include "model/solids/orientation.h"

namespace gpu_planning_scene::core
{
/// The edges that have one triangle, as closed loops. Where such edges end at edges of more triangles, as beside a hole
/// that reaches a wall, the shortest way along other edges closes the loop. None if there are too many open ends.
std::vector<BoundaryEdge> freeRims(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles);
}  // namespace gpu_planning_scene::core
