#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace gpu_planning_scene::core
{
/// Points without repetition, and the number of each vertex's point.
struct Places
{
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> of_vertex;
};

/// Gives vertices at equal coordinates (0 equals -0) the same place.
Places placesOf(const std::vector<Eigen::Vector3d>& vertices);

/// For each point: the number of the point that stands for it. Points within `tolerance` (metres) of each other have
/// the same representative, also along chains of such points, unless a chain is longer than a few tolerances: then its
/// points stand for themselves. The representative is the first of its points in lexicographic order of the
/// coordinates, so it does not depend on the order of the points. Only the points with used[i] take part.
std::vector<std::uint32_t> weld(const std::vector<Eigen::Vector3d>& points, const std::vector<bool>& used,
                                double tolerance);

/// Lexicographic order of the coordinates.
inline bool precedes(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return a.x() != b.x() ? a.x() < b.x() : a.y() != b.y() ? a.y() < b.y() : a.z() < b.z();
}
}  // namespace gpu_planning_scene::core
