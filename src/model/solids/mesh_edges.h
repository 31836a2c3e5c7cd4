#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/solids/disjoint_sets.h"

namespace gpu_planning_scene::core
{
/// The places of a triangle's corners. A place is the number of a point; several vertices may have one place.
using Corners = std::array<std::uint32_t, 3>;

/// Whether the corners are three different places. They may lie on a line.
inline bool hasDistinctCorners(const Corners& c)
{
  return c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
}

/// The use of an edge by a triangle.
struct EdgeUse
{
  std::uint32_t low;  ///< the place with the lower number
  std::uint32_t high;
  std::uint32_t triangle;
  bool upwards;  ///< the triangle runs along the edge from `low` to `high`

  bool sameEdge(const EdgeUse& other) const { return low == other.low && high == other.high; }
};

/// The uses of all edges of the triangles with distinct corners. Uses of the same edge are neighbours, in the order of
/// their triangles.
std::vector<EdgeUse> edgeUses(const std::vector<Corners>& triangles);

/// The patches of a surface, as sets of its triangles: triangles with a common edge that no third one uses are in one.
DisjointSets patchSets(const std::vector<EdgeUse>& uses, std::size_t triangles);

/// Calls visit(first, last) with the uses of each edge.
template <class Visit>
void visitEdges(const std::vector<EdgeUse>& uses, const Visit& visit)
{
  for (auto first = uses.begin(); first != uses.end();)
  {
    const auto last = std::find_if(first, uses.end(), [&](const EdgeUse& use) { return !use.sameEdge(*first); });
    visit(first, last);
    first = last;
  }
}
}  // namespace gpu_planning_scene::core
