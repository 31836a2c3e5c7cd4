#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include <Eigen/Core>

namespace gpu_planning_scene::core
{
/// Combines `hash` with the hash of a point. Equal points have equal hashes, also if one has 0 and the other -0.
inline std::size_t hashOf(const Eigen::Vector3d& point, std::size_t hash = 0)
{
  for (int i = 0; i < 3; ++i)
  {
    hash = (hash ^ std::hash<double>()(point[i])) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 32U;
  }
  return hash;
}

/// Hash function for unordered containers of points.
struct CoordinateHash
{
  std::size_t operator()(const Eigen::Vector3d& point) const { return hashOf(point); }
};
}  // namespace gpu_planning_scene::core
