#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/binned_sah.h"

namespace gpu_planning_scene::core
{
/// A tree over the boxes of the world's objects, with one object in each leaf. Node 0 is the root. A leaf's `first`
/// indexes order(). Immutable.
class ObjectTree
{
 public:
  ObjectTree() = default;
  /// If `previous` has as many boxes, its tree is refitted to the new boxes; this costs a tenth of a new build. A new
  /// tree is built only if the nodes have grown so much that the refitted tree would be slow to traverse.
  ObjectTree(std::vector<Eigen::AlignedBox3d> boxes, const ObjectTree& previous);

  const std::vector<Node>& nodes() const { return tree_.nodes; }
  const std::vector<std::uint32_t>& order() const { return tree_.order; }
  const Eigen::AlignedBox3d& box(std::uint32_t object) const { return boxes_[object]; }

 private:
  void refit();

  std::vector<Eigen::AlignedBox3d> boxes_;
  BoxTree tree_;
  double area_when_built_ = 0.0;  // area of all nodes together: the cost of a traversal by the surface area heuristic
};
}  // namespace gpu_planning_scene::core
