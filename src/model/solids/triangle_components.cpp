#include "model/solids/triangle_components.h"

#include <numeric>

namespace gpu_planning_scene::core
{
namespace
{
/// The corners of a triangle added up. Two triangles with a common edge have the same sum if they have the same
/// corners.
std::uint64_t sumOf(const Corners& corners)
{
  return std::accumulate(corners.begin(), corners.end(), std::uint64_t{0});
}
}  // namespace

std::vector<bool> closedComponents(const std::vector<Corners>& triangles, const std::vector<EdgeUse>& uses,
                                   const TriangleComponents& components)
{
  std::vector<bool> closed(components.count(), false);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (hasDistinctCorners(triangles[t]))
      closed[components.of(t)] = true;
  visitEdges(uses,
             [&](auto first, auto last)
             {
               if (last - first != 2 || first[0].upwards == first[1].upwards ||
                   sumOf(triangles[first[0].triangle]) == sumOf(triangles[first[1].triangle]))
                 closed[components.of(first->triangle)] = false;
             });
  return closed;
}
}  // namespace gpu_planning_scene::core
