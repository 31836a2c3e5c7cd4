#pragma once

#include <cstdint>
#include <vector>

#include "collision/exact/forest.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// What it costs to traverse trees a and b to all pairs of overlapping leaves, summed over random poses in which their
/// root boxes overlap: box tests, and three for each pair of triangles in overlapping leaves (a triangle test takes
/// about three box tests' arithmetic).
double traversalCost(const Forest& forest, const std::vector<Tessellation>& trees, std::size_t a, std::size_t b,
                     std::uint64_t seed);
}  // namespace gpu_planning_scene::core
