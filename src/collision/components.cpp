#include "collision/components.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace gpu_planning_scene
{
namespace
{
/// Disjoint sets with path halving (Tarjan and van Leeuwen 1984).
class DisjointSets
{
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t find(std::uint32_t element)
  {
    while (parent_[element] != element)
    {
      element = parent_[element] = parent_[parent_[element]];
    }
    return element;
  }

  void unite(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// For each vertex the number of its place; equal places have equal numbers.
std::vector<std::uint32_t> weldedVertices(const Mesh& mesh)
{
  std::map<std::tuple<double, double, double>, std::uint32_t> places;
  std::vector<std::uint32_t> welded;
  welded.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices)
  {
    const auto number = static_cast<std::uint32_t>(places.size());
    welded.push_back(places.try_emplace({vertex.x(), vertex.y(), vertex.z()}, number).first->second);
  }
  return welded;
}

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// How often triangles run along each directed edge.
class EdgeUses
{
 public:
  void add(const std::array<std::uint32_t, 3>& corners)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      ++uses_[{corners[i], corners[(i + 1) % 3]}];
    }
  }

  /// Whether each edge of the triangle is run along once in each direction.
  bool allPaired(const std::array<std::uint32_t, 3>& corners) const
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      const std::uint32_t a = corners[i];
      const std::uint32_t b = corners[(i + 1) % 3];
      const auto back = uses_.find({b, a});
      if (uses_.at({a, b}) != 1 || back == uses_.end() || back->second != 1)
      {
        return false;
      }
    }
    return true;
  }

 private:
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses_;
};
}  // namespace

bool MeshComponents::hasSolid() const
{
  return std::any_of(components.begin(), components.end(), [](const Component& part) { return part.closed; });
}

MeshComponents findComponents(const Mesh& mesh)
{
  const std::vector<std::uint32_t> welded = weldedVertices(mesh);
  const auto corners_of = [&](std::size_t triangle) -> std::array<std::uint32_t, 3>
  {
    const auto& t = mesh.triangles[triangle];
    return {welded[t[0]], welded[t[1]], welded[t[2]]};
  };
  const auto has_area = [](const std::array<std::uint32_t, 3>& c)
  { return c[0] != c[1] && c[1] != c[2] && c[2] != c[0]; };

  DisjointSets sets(mesh.vertices.size());
  EdgeUses uses;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
  {
    const auto corners = corners_of(i);
    sets.unite(corners[0], corners[1]);
    sets.unite(corners[1], corners[2]);
    if (has_area(corners))
    {
      uses.add(corners);
    }
  }

  MeshComponents found;
  std::vector<std::size_t> number_of(mesh.vertices.size(), kNone);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
  {
    std::size_t& number = number_of[sets.find(corners_of(i)[0])];
    if (number == kNone)
    {
      number = found.components.size();
      found.components.push_back({mesh.vertices[mesh.triangles[i][0]], {}, false});
    }
    for (const std::uint32_t vertex : mesh.triangles[i])
    {
      found.components[number].bounds.extend(mesh.vertices[vertex]);
    }
  }
  // A component without any triangle that has area stays open.
  std::vector<std::uint8_t> broken(found.components.size(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
  {
    const auto corners = corners_of(i);
    const std::size_t number = number_of[sets.find(corners[0])];
    if (has_area(corners))
    {
      found.components[number].closed = true;
      broken[number] |= uses.allPaired(corners) ? 0 : 1;
    }
  }
  for (std::size_t number = 0; number < broken.size(); ++number)
  {
    found.components[number].closed = found.components[number].closed && broken[number] == 0;
  }
  found.bounds_solid.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
  {
    const auto corners = corners_of(i);
    found.bounds_solid.push_back(has_area(corners) && found.components[number_of[sets.find(corners[0])]].closed ? 1
                                                                                                                : 0);
  }
  return found;
}
}  // namespace gpu_planning_scene
