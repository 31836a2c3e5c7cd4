#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "gpu_planning_scene/shapes.h"
#include "model/solids/mesh_edges.h"
#include "model/solids/welding.h"

namespace gpu_planning_scene::core
{
/// A mesh to which triangles are added, and whose triangles may be turned. Without a change, it is not copied.
class ChangedMesh
{
 public:
  ChangedMesh(std::shared_ptr<const Mesh> mesh, const Places& places)
    : mesh_(std::move(mesh)), places_(places), vertex_at_(places.points.size())
  {
    for (std::size_t i = mesh_->vertices.size(); i-- > 0;)
      vertex_at_[places.of_vertex[i]] = static_cast<std::uint32_t>(i);
  }

  /// Gives the triangle the direction of `corners`, which are its places.
  void turn(std::size_t triangle, const Corners& corners)
  {
    const auto& vertices = mesh_->triangles[triangle];
    if (places_.of_vertex[vertices[1]] != corners[1])
      turn(triangle);
  }

  void turn(std::size_t triangle) { std::swap(copy().triangles[triangle][1], copy().triangles[triangle][2]); }

  void add(const Corners& corners)
  {
    copy().triangles.push_back({vertex_at_[corners[0]], vertex_at_[corners[1]], vertex_at_[corners[2]]});
  }

  const std::shared_ptr<const Mesh>& get() const { return mesh_; }

 private:
  Mesh& copy()
  {
    if (!copy_)
      mesh_ = copy_ = std::make_shared<Mesh>(*mesh_);
    return *copy_;
  }

  std::shared_ptr<const Mesh> mesh_;
  std::shared_ptr<Mesh> copy_;
  const Places& places_;
  std::vector<std::uint32_t> vertex_at_;
};
}  // namespace gpu_planning_scene::core
