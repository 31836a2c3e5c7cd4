#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "model/solids/orientation.h"

namespace gpu_planning_scene::core
{
/// A point of the triangle's inside, for lines and rays: off its centre and medians, where other triangles have edges.
Eigen::Vector3d pointWithin(const std::vector<Eigen::Vector3d>& points, const Corners& triangle);

/// The largest triangle of each set, each once, the largest first; of many sets, the `most` largest. `members`: numbers
/// of sets with their triangles.
std::vector<std::uint32_t> largestOfSets(const std::vector<Eigen::Vector3d>& points,
                                         const std::vector<Corners>& triangles,
                                         const std::vector<std::pair<std::uint32_t, std::uint32_t>>& members,
                                         std::size_t most);
}  // namespace gpu_planning_scene::core
