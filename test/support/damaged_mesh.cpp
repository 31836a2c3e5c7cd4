#include "support/damaged_mesh.h"

#include <algorithm>
#include <numeric>

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

std::uint32_t addVertex(Mesh& mesh, const Vector3d& vertex)
{
  mesh.vertices.push_back(vertex);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// Cuts an edge of the triangle at one to three points. The neighbour on the other side is not cut.
void split(Mesh& mesh, std::size_t triangle, std::mt19937_64& generator)
{
  std::array<std::uint32_t, 3> t = mesh.triangles[triangle];
  std::rotate(t.begin(), t.begin() + generator() % 3, t.end());
  const std::size_t cuts = 1 + generator() % 3;
  std::uint32_t from = t[0];
  for (std::size_t i = 1; i <= cuts; ++i)
  {
    const double at = static_cast<double>(i) / static_cast<double>(cuts + 1);
    const std::uint32_t to = addVertex(mesh, (1.0 - at) * mesh.vertices[t[0]] + at * mesh.vertices[t[1]]);
    mesh.triangles.push_back({from, to, t[2]});
    from = to;
  }
  mesh.triangles[triangle] = {from, t[1], t[2]};
}

void shift(Mesh& mesh, std::size_t triangle, double length, std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> uniform(-length, length);
  for (std::uint32_t& corner : mesh.triangles[triangle])
    corner = addVertex(mesh, mesh.vertices[corner] +
                                 Vector3d(uniform(generator), uniform(generator), uniform(generator)) / std::sqrt(3.0));
}

void shuffle(Mesh& mesh, std::mt19937_64& generator)
{
  std::vector<std::uint32_t> order(3 * mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), generator);
  std::vector<Vector3d> vertices(order.size());
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), generator);
  std::size_t next = 0;
  for (auto& t : mesh.triangles)
  {
    std::rotate(t.begin(), t.begin() + generator() % 3, t.end());
    for (std::uint32_t& corner : t)
    {
      vertices[order[next]] = mesh.vertices[corner];
      corner = order[next++];
    }
  }
  mesh.vertices = std::move(vertices);
}
}  // namespace

const std::vector<MeshDamage>& allMeshDamages()
{
  static const std::vector<MeshDamage> all = {MeshDamage::Flipped, MeshDamage::Doubled, MeshDamage::FrontAndBack,
                                              MeshDamage::Split,   MeshDamage::Shifted, MeshDamage::Cracked,
                                              MeshDamage::Deleted, MeshDamage::Shuffled};
  return all;
}

std::string nameOf(MeshDamage damage)
{
  static const std::vector<std::string> names = {"flipped", "doubled", "front and back", "split",
                                                 "shifted", "cracked", "deleted",        "shuffled"};
  return names.at(static_cast<std::size_t>(damage));
}

std::shared_ptr<const Mesh> damaged(const Mesh& mesh, MeshDamage damage, double share, std::mt19937_64& generator)
{
  auto copy = std::make_shared<Mesh>(mesh);
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices)
    box.extend(vertex);
  const double size = box.diagonal().norm();
  const std::size_t count = mesh.triangles.size();
  std::vector<std::size_t> chosen(count);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  std::shuffle(chosen.begin(), chosen.end(), generator);
  chosen.resize(std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(count))));
  std::sort(chosen.rbegin(), chosen.rend());
  if (damage == MeshDamage::FrontAndBack)
    for (const auto& t : mesh.triangles)
      copy->triangles.push_back({t[0], t[2], t[1]});
  if (damage == MeshDamage::Shuffled)
    shuffle(*copy, generator);
  for (const std::size_t t : chosen)
    if (damage == MeshDamage::Flipped)
      std::swap(copy->triangles[t][0], copy->triangles[t][1]);
    else if (damage == MeshDamage::Doubled)
      copy->triangles.push_back(std::array<std::uint32_t, 3>(copy->triangles[t]));
    else if (damage == MeshDamage::Split)
      split(*copy, t, generator);
    else if (damage == MeshDamage::Shifted)
      shift(*copy, t, 1e-7 * size, generator);
    else if (damage == MeshDamage::Cracked)
      shift(*copy, t, 4e-4 * size, generator);
    else if (damage == MeshDamage::Deleted)
      copy->triangles.erase(copy->triangles.begin() + static_cast<std::ptrdiff_t>(t));
  return copy;
}
}  // namespace gpu_planning_scene::core
