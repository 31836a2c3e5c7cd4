#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/binned_sah.h"

namespace gpu_planning_scene::core
{
/// The tree over the boxes of a world's objects, one object in each leaf: node 0 is the root, a leaf's `first` indexes
/// order(). Immutable.
class ObjectTree
{
 public:
  ObjectTree() = default;
  /// `previous`, where it has as many boxes, gives its tree: boxes that moved are made to fit, which costs a tenth of a
  /// new tree. Only where its boxes have grown so much that it would be slow to traverse, a new one is built.
  ObjectTree(std::vector<Eigen::AlignedBox3d> boxes, const ObjectTree& previous);

  const std::vector<Node>& nodes() const { return tree_.nodes; }
  const std::vector<std::uint32_t>& order() const { return tree_.order; }
  const Eigen::AlignedBox3d& box(std::uint32_t object) const { return boxes_[object]; }

 private:
  void refit();

  std::vector<Eigen::AlignedBox3d> boxes_;
  BoxTree tree_;
  double area_when_built_ = 0.0;  // of all nodes together: what a traversal costs, by the surface area heuristic
};
}  // namespace gpu_planning_scene::core
