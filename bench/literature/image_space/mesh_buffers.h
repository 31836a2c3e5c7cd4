#pragma once

#include <cstddef>
#include <memory>

#include <Eigen/Core>

#include "gpu/buffer.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
/// A mesh in the memory of the device. Its triangles are sorted so that neighbours in the list are near each other in
/// space. Used on the context's thread.
class MeshBuffers
{
 public:
  explicit MeshBuffers(std::shared_ptr<const Mesh> mesh);
  ~MeshBuffers();
  MeshBuffers(const MeshBuffers&) = delete;
  MeshBuffers& operator=(const MeshBuffers&) = delete;

  const std::shared_ptr<const Mesh>& mesh() const { return mesh_; }
  /// The origin of the coordinates on the device, in the frame of the mesh.
  const Eigen::Vector3d& center() const { return center_; }
  /// The triangles in the order of the device: indices into mesh()->triangles.
  const std::vector<std::uint32_t>& order() const { return order_; }
  std::size_t triangleCount() const { return order_.size(); }
  std::size_t edgeCount() const { return edge_count_; }

  /// Draws all triangles, or each edge once as a line, in `tiles` instances with the current program.
  void drawTriangles(std::size_t tiles) const;
  void drawEdges(std::size_t tiles) const;
  /// Draws the triangle of kScreenVertexShader, which needs no vertices.
  void drawScreen() const;
  /// Binds the vertices (three floats each) and the triangles (three indices each) as storage buffers.
  void bindStorage() const;

 private:
  std::shared_ptr<const Mesh> mesh_;
  Eigen::Vector3d center_;
  std::vector<std::uint32_t> order_;
  std::size_t edge_count_ = 0;
  Buffer vertices_;
  Buffer triangles_;
  Buffer edges_;
  unsigned array_ = 0;
};
}  // namespace gpu_planning_scene::core::literature
