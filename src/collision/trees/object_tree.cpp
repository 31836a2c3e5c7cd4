#include "collision/trees/object_tree.h"

#include <utility>

// Refits the previous tree from the leaves to the root (G. van den Bergen: Efficient Collision Detection of Complex
// Deformable Models using AABB Trees. Journal of Graphics Tools 2(4), 1997). The areas of the nodes tell when the
// refitted tree has become too slow and a new one is built (the idea of C. Lauterbach et al.: RT-DEFORM: Interactive
// Ray Tracing of Dynamic Scenes using BVHs, 2006).
namespace gpu_planning_scene::core
{
namespace
{
/// If the nodes' areas have grown by more than this factor, building a new tree pays off.
constexpr double kMaxGrowth = 1.2;

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
    if (areaOf(tree_.nodes) <= kMaxGrowth * area_when_built_)
      return;
  }
  tree_ = buildBinnedSah(boxes_, 1);
  area_when_built_ = areaOf(tree_.nodes);
}

/// Visits the nodes backwards, because children come after their parents.
void ObjectTree::refit()
{
  for (auto node = tree_.nodes.rbegin(); node != tree_.nodes.rend(); ++node)
    setBox(node->count > 0 ? boxes_[tree_.order[node->first]]
                           : boundsOf(tree_.nodes[node->first]).merged(boundsOf(tree_.nodes[node->first + 1])),
           *node);
}
}  // namespace gpu_planning_scene::core
