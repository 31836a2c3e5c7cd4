#include "collision/geometry/components.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "model/coordinate_hash.h"

// Merges vertices at equal places and finds the connected components with disjoint sets. Then sorts the edges by their
// ends and looks for unpaired edges. An edge is paired if exactly two triangles share it, in opposite directions.
// Disjoint sets: R. E. Tarjan, J. van Leeuwen: Worst-case analysis of set union algorithms. Journal of the ACM 31(2),
// 1984. The test of the edges is the definition of a closed, consistently oriented surface.
namespace gpu_planning_scene::core
{
namespace
{
/// Disjoint sets with path halving.
class DisjointSets
{
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t find(std::uint32_t element)
  {
    while (parent_[element] != element)
      element = parent_[element] = parent_[parent_[element]];
    return element;
  }

  void unite(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The number of each vertex's place. Vertices at equal coordinates get equal numbers.
std::vector<std::uint32_t> weldedVertices(const Mesh& mesh)
{
  std::unordered_map<Eigen::Vector3d, std::uint32_t, CoordinateHash> places;
  places.reserve(mesh.vertices.size());
  std::vector<std::uint32_t> welded;
  welded.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices)
  {
    const auto number = static_cast<std::uint32_t>(places.size());
    welded.push_back(places.try_emplace(vertex, number).first->second);
  }
  return welded;
}

using Corners = std::array<std::uint32_t, 3>;

/// Whether the corners are three different places. They may lie on a line.
bool hasDistinctCorners(const Corners& c)
{
  return c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
}

/// Calls visit(triangle) for each triangle with an edge that is not shared by exactly two triangles in opposite
/// directions.
template <class Visit>
void visitUnpaired(const std::vector<Corners>& triangles, std::size_t places, const Visit& visit)
{
  struct Use
  {
    std::uint32_t higher;  // the vertex number at the edge's other end
    std::uint32_t triangle;
    bool upwards;  // the triangle runs along the edge from the lower vertex number to the higher one
  };
  // The uses are grouped by the lower vertex number of their edge (counting sort).
  std::vector<std::uint32_t> begin(places + 1, 0);
  const auto for_edges = [&](const auto& each)
  {
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 3 && hasDistinctCorners(triangles[t]); ++i)
        each(t, triangles[t][i], triangles[t][(i + 1) % 3]);
  };
  for_edges([&](std::uint32_t, std::uint32_t a, std::uint32_t b) { ++begin[std::min(a, b) + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Use> uses(begin.back());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for_edges(
      [&](std::uint32_t t, std::uint32_t a, std::uint32_t b) {
        uses[next[std::min(a, b)]++] = {std::max(a, b), t, a < b};
      });
  for (std::size_t place = 0; place < places; ++place)
  {
    const auto first = uses.begin() + begin[place];
    const auto last = uses.begin() + begin[place + 1];
    std::sort(first, last, [](const Use& a, const Use& b) { return a.higher < b.higher; });
    for (auto use = first; use != last;)
    {
      const auto end = std::find_if(use, last, [&](const Use& other) { return other.higher != use->higher; });
      if (end - use != 2 || use->upwards == std::next(use)->upwards)
        std::for_each(use, end, [&](const Use& unpaired) { visit(unpaired.triangle); });
      use = end;
    }
  }
}

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
}  // namespace

bool MeshComponents::hasSolid() const
{
  return std::any_of(
      components.begin(), components.end(), [](const Component& part) { return part.closed; });
}

MeshComponents findComponents(const Mesh& mesh)
{
  const std::vector<std::uint32_t> welded = weldedVertices(mesh);
  std::vector<Corners> triangles;
  triangles.reserve(mesh.triangles.size());
  DisjointSets sets(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
  {
    triangles.push_back({welded[t[0]], welded[t[1]], welded[t[2]]});
    sets.unite(triangles.back()[0], triangles.back()[1]);
    sets.unite(triangles.back()[1], triangles.back()[2]);
  }

  MeshComponents found;
  std::vector<std::size_t> number_of_set(mesh.vertices.size(), kNone);
  const auto component_of = [&](std::size_t t) -> std::size_t& { return number_of_set[sets.find(triangles[t][0])]; };
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    std::size_t& number = component_of(t);
    if (number == kNone)
    {
      number = found.components.size();
      found.components.push_back({mesh.vertices[mesh.triangles[t][0]], {}, false});
    }
    Component& component = found.components[number];
    component.closed = component.closed || hasDistinctCorners(triangles[t]);
    for (const std::uint32_t vertex : mesh.triangles[t])
      component.bounds.extend(mesh.vertices[vertex]);
  }
  visitUnpaired(triangles, mesh.vertices.size(),
                [&](std::uint32_t t) { found.components[component_of(t)].closed = false; });

  found.bounds_solid.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    found.bounds_solid.push_back(hasDistinctCorners(triangles[t]) && found.components[component_of(t)].closed ? 1 : 0);
  return found;
}
}  // namespace gpu_planning_scene::core
