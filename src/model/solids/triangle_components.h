#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "model/solids/disjoint_sets.h"
#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
/// The triangles' connected components: triangles that share a place are connected.
class TriangleComponents
{
 public:
  TriangleComponents(const std::vector<Corners>& triangles, std::size_t places) : sets_(places)
  {
    for (const Corners& t : triangles)
    {
      sets_.unite(t[0], t[1]);
      sets_.unite(t[1], t[2]);
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number_of_set(places, kNone);
    of_triangle_.reserve(triangles.size());
    for (const Corners& t : triangles)
    {
      std::uint32_t& number = number_of_set[sets_.find(t[0])];
      if (number == kNone)
        number = count_++;
      of_triangle_.push_back(number);
    }
  }

  std::uint32_t of(std::size_t triangle) const { return of_triangle_[triangle]; }
  std::size_t count() const { return count_; }

 private:
  DisjointSets sets_;
  std::vector<std::uint32_t> of_triangle_;
  std::uint32_t count_ = 0;
};

/// For each component: whether each of its edges belongs to two triangles of opposite direction. A triangle and its
/// back side bound nothing: they may be a part of a surface from which rounding separates them.
std::vector<bool> closedComponents(const std::vector<Corners>& triangles, const std::vector<EdgeUse>& uses,
                                   const TriangleComponents& components);
}  // namespace gpu_planning_scene::core
