#include "collision/object_tree.h"

#include <utility>

namespace gpu_planning_scene
{
namespace
{
/// Past this growth of the nodes' areas a new tree pays.
constexpr double kMostGrowth = 1.2;

Eigen::AlignedBox3d boxOf(const Node& node)
{
  const Eigen::Vector3d center(node.center[0], node.center[1], node.center[2]);
  const Eigen::Vector3d half(node.half[0], node.half[1], node.half[2]);
  return {center - half, center + half};
}

double areaOf(const std::vector<Node>& nodes)
{
  double area = 0.0;
  for (const Node& node : nodes)
  {
    const double x = node.half[0];
    const double y = node.half[1];
    const double z = node.half[2];
    area += x * y + y * z + z * x;
  }
  return area;
}
}  // namespace

ObjectTree::ObjectTree(std::vector<Eigen::AlignedBox3d> boxes, const ObjectTree& previous) : boxes_(std::move(boxes))
{
  if (boxes_.size() == previous.boxes_.size())
  {
    tree_ = previous.tree_;
    area_when_built_ = previous.area_when_built_;
    refit();
    if (areaOf(tree_.nodes) <= kMostGrowth * area_when_built_)
      return;
  }
  tree_ = buildBinnedSah(boxes_, 1);
  area_when_built_ = areaOf(tree_.nodes);
}

/// Children come after their parents.
void ObjectTree::refit()
{
  for (auto node = tree_.nodes.rbegin(); node != tree_.nodes.rend(); ++node)
    setBox(node->count > 0 ? boxes_[tree_.order[node->first]]
                           : boxOf(tree_.nodes[node->first]).merged(boxOf(tree_.nodes[node->first + 1])),
           *node);
}
}  // namespace gpu_planning_scene
