#include "model/solids/largest_triangles.h"

#include <algorithm>
#include <map>
#include <set>

namespace gpu_planning_scene::core
{
Eigen::Vector3d pointWithin(const std::vector<Eigen::Vector3d>& points, const Corners& triangle)
{
  return 0.31 * points[triangle[0]] + 0.36 * points[triangle[1]] + 0.33 * points[triangle[2]];
}

std::vector<std::uint32_t> largestOfSets(const std::vector<Eigen::Vector3d>& points,
                                         const std::vector<Corners>& triangles,
                                         const std::vector<std::pair<std::uint32_t, std::uint32_t>>& members,
                                         std::size_t most)
{
  const auto is_larger = [&](std::uint32_t a, std::uint32_t b)
  { return areaNormal(points, triangles[a]).squaredNorm() > areaNormal(points, triangles[b]).squaredNorm(); };
  std::map<std::uint32_t, std::uint32_t> of_set;
  for (const auto& [set, triangle] : members)
    if (std::uint32_t& known = of_set.try_emplace(set, triangle).first->second; is_larger(triangle, known))
      known = triangle;
  std::set<std::uint32_t> distinct;
  for (const auto& [set, triangle] : of_set)
    distinct.insert(triangle);
  std::vector<std::uint32_t> largest(distinct.begin(), distinct.end());
  std::sort(largest.begin(), largest.end(), is_larger);
  largest.resize(std::min(largest.size(), most));
  return largest;
}
}  // namespace gpu_planning_scene::core
