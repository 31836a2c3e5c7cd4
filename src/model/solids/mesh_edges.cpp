#include "model/solids/mesh_edges.h"

#include <numeric>

// The uses are grouped by the lower place of their edge (counting sort), then sorted in each group.
namespace gpu_planning_scene::core
{
namespace
{
template <class Visit>
void eachUse(const std::vector<Corners>& triangles, const Visit& visit)
{
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3 && hasDistinctCorners(triangles[t]); ++i)
    {
      const std::uint32_t a = triangles[t][i];
      const std::uint32_t b = triangles[t][(i + 1) % 3];
      visit(EdgeUse{std::min(a, b), std::max(a, b), t, a < b});
    }
}
}  // namespace

std::vector<EdgeUse> edgeUses(const std::vector<Corners>& triangles)
{
  constexpr std::size_t kManyPlaces = 8;  // per triangle: the table of places would take longer than sorting
  std::uint32_t places = 0;
  for (const Corners& triangle : triangles)
    places = std::max({places, triangle[0] + 1, triangle[1] + 1, triangle[2] + 1});
  if (places > kManyPlaces * triangles.size())
  {
    std::vector<EdgeUse> sorted;
    sorted.reserve(3 * triangles.size());
    eachUse(
        triangles, [&](const EdgeUse& use) { sorted.push_back(use); });
    std::sort(sorted.begin(), sorted.end(),
              [](const EdgeUse& a, const EdgeUse& b) {
                return std::array{a.low, a.high, a.triangle} < std::array{b.low, b.high, b.triangle};
              });
    return sorted;
  }
  std::vector<std::uint32_t> begin(places + std::size_t{1}, 0);
  eachUse(triangles, [&](const EdgeUse& use) { ++begin[use.low + std::size_t{1}]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<EdgeUse> uses(begin.back());
  std::vector<std::uint32_t> next = begin;
  eachUse(triangles, [&](const EdgeUse& use) { uses[next[use.low]++] = use; });
  for (std::size_t place = 0; place < places; ++place)
    std::sort(uses.begin() + begin[place], uses.begin() + begin[place + 1],
              [](const EdgeUse& a, const EdgeUse& b)
              { return a.high != b.high ? a.high < b.high : a.triangle < b.triangle; });
  return uses;
}

DisjointSets patchSets(const std::vector<EdgeUse>& uses, std::size_t triangles)
{
  DisjointSets sets(triangles);
  visitEdges(uses,
             [&](auto first, auto last)
             {
               if (last - first == 2)
                 sets.unite(first[0].triangle, first[1].triangle);
             });
  return sets;
}
}  // namespace gpu_planning_scene::core
