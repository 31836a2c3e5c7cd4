#include "literature/image_space/mesh_buffers.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include <epoxy/gl.h>

#include "collision/geometry/median_split.h"
#include "literature/image_space/draw_program.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Indices = std::vector<std::uint32_t>;

Indices sortedBySpace(const Mesh& mesh)
{
  Indices order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  sortBySplits(order.begin(), order.end(),
               [&mesh](std::uint32_t triangle) -> Eigen::Vector3d
               {
                 const auto& t = mesh.triangles[triangle];
                 return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
               });
  return order;
}

/// The ends of each edge, each edge once.
Indices edgesOf(const Mesh& mesh)
{
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      edges.push_back(std::minmax({triangle[i], triangle[(i + 1) % 3]}));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  Indices ends;
  for (const auto& [first, second] : edges)
    ends.insert(ends.end(), {first, second});
  return ends;
}

Buffer uploaded(const void* data, std::size_t size)
{
  Buffer buffer(size);
  buffer.write(data, size);
  return buffer;
}
}  // namespace

MeshBuffers::MeshBuffers(std::shared_ptr<const Mesh> mesh) : mesh_(std::move(mesh)), order_(sortedBySpace(*mesh_))
{
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh_->vertices)
    bounds.extend(vertex);
  center_ = bounds.center();
  std::vector<Eigen::Vector3f> vertices;
  for (const Eigen::Vector3d& vertex : mesh_->vertices)
    vertices.emplace_back((vertex - center_).cast<float>());
  Indices corners;
  for (const std::uint32_t triangle : order_)
    corners.insert(corners.end(), mesh_->triangles[triangle].begin(), mesh_->triangles[triangle].end());
  const Indices edges = edgesOf(*mesh_);
  edge_count_ = edges.size() / 2;
  vertices_ = uploaded(vertices.data(), vertices.size() * sizeof(Eigen::Vector3f));
  triangles_ = uploaded(corners.data(), corners.size() * sizeof(std::uint32_t));
  edges_ = uploaded(edges.data(), edges.size() * sizeof(std::uint32_t));

  glCreateVertexArrays(1, &array_);
  glVertexArrayVertexBuffer(array_, 0, vertices_.id(), 0, sizeof(Eigen::Vector3f));
  glEnableVertexArrayAttrib(array_, kPositionAttribute);
  glVertexArrayAttribFormat(array_, kPositionAttribute, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array_, kPositionAttribute, 0);
}

MeshBuffers::~MeshBuffers()
{
  glDeleteVertexArrays(1, &array_);
}

void MeshBuffers::drawTriangles(std::size_t tiles) const
{
  glVertexArrayElementBuffer(array_, triangles_.id());
  glBindVertexArray(array_);
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(3 * order_.size()), GL_UNSIGNED_INT, nullptr,
                          static_cast<GLsizei>(tiles));
}

void MeshBuffers::drawEdges(std::size_t tiles) const
{
  glVertexArrayElementBuffer(array_, edges_.id());
  glBindVertexArray(array_);
  glDrawElementsInstanced(GL_LINES, static_cast<GLsizei>(2 * edge_count_), GL_UNSIGNED_INT, nullptr,
                          static_cast<GLsizei>(tiles));
}

void MeshBuffers::drawScreen() const
{
  glBindVertexArray(array_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void MeshBuffers::bindStorage() const
{
  vertices_.bindStorage(kVerticesBinding);
  triangles_.bindStorage(kTrianglesBinding);
}
}  // namespace gpu_planning_scene::core::literature
