#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "literature/trees/tree_method.h"

namespace gpu_planning_scene::core::literature
{
/// A tree of oriented boxes over the triangles of a mesh. A leaf has one triangle.
class OrientedBoxTree
{
 public:
  /// A box in the frame of its parent's box; the root's box in the frame of the mesh.
  struct Node
  {
    Eigen::Matrix3d rotation;  ///< the box's axes as columns
    Eigen::Vector3d center;
    Eigen::Vector3d half;
    std::uint32_t child = 0;  ///< of two children, child and child + 1; 0: a leaf
    std::uint32_t triangle = 0;
  };

  explicit OrientedBoxTree(const Mesh& mesh);
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  struct Placed
  {
    Eigen::Matrix3d rotation;
    Eigen::Vector3d center;
  };
  void build(std::uint32_t node, std::uint32_t* begin, std::uint32_t* end, const Placed& parent);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

/// Whether one of 15 axes separates two boxes. `rotation`, `translation`: the frame of b in the frame of a. `epsilon`
/// is added to each absolute value of the rotation.
bool boxesApart(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation, const Eigen::Vector3d& half_a,
                const Eigen::Vector3d& half_b, double epsilon);

constexpr double kRapidEpsilon = 1e-6;

using OrientedBoxTreePtr = std::shared_ptr<const OrientedBoxTree>;
/// See sharedTree.
OrientedBoxTreePtr orientedBoxTree(const MeshPtr& mesh);

/// `epsilon`: see boxesApart.
std::unique_ptr<Method> makeOrientedBoxes(const MeshPtr& a, const MeshPtr& b, double epsilon, Search search);
}  // namespace gpu_planning_scene::core::literature
