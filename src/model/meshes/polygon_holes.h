#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace gpu_planning_scene::core
{
/// A closed line through points, as their indices.
using Loop = std::vector<std::uint32_t>;

/// Joins a counterclockwise outline and its clockwise holes to one loop, by bridges that it passes in both directions.
/// Throws Error if a hole is not inside the outline.
Loop joinHoles(const std::vector<Eigen::Vector2d>& points, Loop outline, std::vector<Loop> holes);
}  // namespace gpu_planning_scene::core
