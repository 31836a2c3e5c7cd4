#pragma once

#include <cstdint>
#include <vector>

#include "collision/trees/forest.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// The cost of traversing trees a and b to all pairs of overlapping leaves, summed over random poses near the surface
/// of a's root box. A box test costs 1 and a pair of triangles in overlapping leaves costs 3, because a triangle test
/// takes about the arithmetic of three box tests.
double traversalCost(const Forest& forest, const std::vector<Tessellation>& trees, std::size_t a, std::size_t b,
                     std::uint64_t seed);
}  // namespace gpu_planning_scene::core
