#include "model/files/mesh_pipe.h"

#include <array>
#include <cstring>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using Counts = std::array<std::uint64_t, 2>;
using Triangle = std::array<std::uint32_t, 3>;
constexpr std::size_t kVertexBytes = 3 * sizeof(double);
constexpr std::size_t kTriangleBytes = sizeof(Triangle);
static_assert(sizeof(Eigen::Vector3d) == kVertexBytes);

std::size_t bytesOf(std::size_t vertices, std::size_t triangles)
{
  return sizeof(Counts) + vertices * kVertexBytes + triangles * kTriangleBytes;
}
}  // namespace

std::string meshBytes(const Mesh& mesh)
{
  const Counts counts{mesh.vertices.size(), mesh.triangles.size()};
  std::string bytes;
  bytes.reserve(bytesOf(mesh.vertices.size(), mesh.triangles.size()));
  bytes.append(reinterpret_cast<const char*>(counts.data()), sizeof counts);
  bytes.append(reinterpret_cast<const char*>(mesh.vertices.data()), mesh.vertices.size() * kVertexBytes);
  bytes.append(reinterpret_cast<const char*>(mesh.triangles.data()), mesh.triangles.size() * kTriangleBytes);
  return bytes;
}

std::size_t maxMeshBytes(std::size_t triangles)
{
  return bytesOf(3 * triangles, triangles);
}

std::shared_ptr<const Mesh> meshFromBytes(const std::string& bytes, const std::string& path, std::size_t max_triangles)
{
  const std::string file = "mesh file '" + path + "': ";
  Counts counts{};
  if (bytes.size() >= sizeof counts)
    std::memcpy(counts.data(), bytes.data(), sizeof counts);
  const auto& [vertices, triangles] = counts;
  if (triangles > max_triangles)
    throw Error(file + "it has " + std::to_string(triangles) + " triangles; at most " + std::to_string(max_triangles) +
                " are allowed");
  // The counts are limited first, so that bytesOf() cannot overflow.
  if (vertices > 3 * triangles || bytes.size() != bytesOf(vertices, triangles))
    throw Error(file + "the reader's answer cannot be understood");
  auto mesh = std::make_shared<Mesh>();
  mesh->name = path;
  mesh->vertices.resize(vertices);
  mesh->triangles.resize(triangles);
  if (vertices != 0)
    std::memcpy(mesh->vertices.front().data(), bytes.data() + sizeof counts, vertices * kVertexBytes);
  if (triangles != 0)
    std::memcpy(mesh->triangles.data(), bytes.data() + sizeof counts + vertices * kVertexBytes,
                triangles * kTriangleBytes);
  try
  {
    validateMesh(*mesh);
  }
  catch (const Error& error)
  {
    throw Error(file + error.what());
  }
  return mesh;
}
}  // namespace gpu_planning_scene::core
