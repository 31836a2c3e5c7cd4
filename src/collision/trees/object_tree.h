#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/trees/binned_sah.h"

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

  /// Calls visit(object) for the objects whose boxes overlap `bounds`, until visit returns true. Returns whether it
  /// did. `bounds` may be infinite. `stack`: work space, which visit must not use.
  template <class Visit>
  bool visitOverlapping(const Eigen::AlignedBox3d& bounds, std::vector<std::uint32_t>& stack, const Visit& visit) const;

 private:
  void refit();

  std::vector<Eigen::AlignedBox3d> boxes_;
  BoxTree tree_;
  double area_when_built_ = 0.0;  // area of all nodes together: the cost of a traversal by the surface area heuristic
};

template <class Visit>
bool ObjectTree::visitOverlapping(const Eigen::AlignedBox3d& bounds, std::vector<std::uint32_t>& stack,
                                  const Visit& visit) const
{
  if (tree_.nodes.empty())
    return false;
  const Eigen::Vector3d center = bounds.center();
  const Eigen::Vector3d half = 0.5 * bounds.sizes();
  stack.clear();
  const auto push_if_near = [&](std::uint32_t index)
  {
    const Node& node = tree_.nodes[index];
    // Not apart for infinite bounds: their centre is infinite or NaN, and their half size is infinite.
    if (!((centerOf(node) - center).cwiseAbs().array() > (halfOf(node) + half).array()).any())
      stack.push_back(index);
  };
  push_if_near(0);
  while (!stack.empty())
  {
    const Node& node = tree_.nodes[stack.back()];
    stack.pop_back();
    if (node.count == 0)
    {
      push_if_near(node.first);
      push_if_near(node.first + 1);
      continue;
    }
    const std::uint32_t object = tree_.order[node.first];
    if (boxes_[object].intersects(bounds) && visit(object))
      return true;
  }
  return false;
}
}  // namespace gpu_planning_scene::core
