#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core::literature
{
/// The points of a part of a shape.
using Piece = std::vector<Eigen::Vector3d>;

/// A binary tree of convex hulls over the pieces of a shape. A leaf has the hull of a piece, an inner node the hull of
/// its children.
class HullTree
{
 public:
  explicit HullTree(const std::vector<Piece>& pieces);

  /// The root is node 0. The children of an inner node are `child` and `child + 1`.
  struct Node
  {
    std::vector<Eigen::Vector3d> vertices;
    Eigen::Vector3d center;   ///< the mean of the vertices
    double radius = 0.0;      ///< of a sphere around `center` that contains the vertices
    std::uint32_t child = 0;  ///< 0: a leaf
  };
  const std::vector<Node>& nodes() const { return nodes_; }
  std::size_t pieceCount() const { return (nodes_.size() + 1) / 2; }

 private:
  void build(std::uint32_t node, std::vector<Node>& leaves, std::size_t begin, std::size_t end);

  double tolerance_;
  std::vector<Node> nodes_;
};
}  // namespace gpu_planning_scene::core::literature
