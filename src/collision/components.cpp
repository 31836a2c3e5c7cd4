#include "collision/components.h"

#include <map>
#include <numeric>
#include <tuple>

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
}  // namespace

std::vector<Eigen::Vector3d> componentPoints(const Mesh& mesh, std::size_t limit)
{
  const std::vector<std::uint32_t> welded = weldedVertices(mesh);
  DisjointSets sets(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles)
  {
    sets.unite(welded[triangle[0]], welded[triangle[1]]);
    sets.unite(welded[triangle[1]], welded[triangle[2]]);
  }
  std::vector<bool> known(mesh.vertices.size(), false);
  std::vector<Eigen::Vector3d> points;
  for (const auto& triangle : mesh.triangles)
  {
    const std::uint32_t component = sets.find(welded[triangle[0]]);
    if (known[component])
    {
      continue;
    }
    if (points.size() == limit)
    {
      return {};
    }
    known[component] = true;
    points.push_back(mesh.vertices[triangle[0]]);
  }
  return points;
}
}  // namespace gpu_planning_scene
