#include "literature/convex/hull_tree.h"

#include <algorithm>

#include "collision/geometry/median_split.h"
#include "literature/convex/convex_hull.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
// As a share of the size of the shape: points so near to the hull of the others are left out. It is far below the
// errors of GJK.
constexpr double kHullTolerance = 1e-13;

HullTree::Node nodeOf(const std::vector<Eigen::Vector3d>& points, double tolerance)
{
  HullTree::Node node;
  node.center.setZero();
  for (const std::uint32_t vertex : convexHull(points, tolerance).vertices)
    node.vertices.push_back(points[vertex]);
  for (const Eigen::Vector3d& vertex : node.vertices)
    node.center += vertex / static_cast<double>(node.vertices.size());
  for (const Eigen::Vector3d& vertex : node.vertices)
    node.radius = std::max(node.radius, (vertex - node.center).norm());
  return node;
}
}  // namespace

HullTree::HullTree(const std::vector<Piece>& pieces)
{
  Eigen::AlignedBox3d bounds;
  for (const Piece& piece : pieces)
    for (const Eigen::Vector3d& point : piece)
      bounds.extend(point);
  tolerance_ = kHullTolerance * bounds.diagonal().norm();
  std::vector<Node> leaves;
  for (const Piece& piece : pieces)
    leaves.push_back(nodeOf(piece, tolerance_));
  nodes_.reserve(2 * leaves.size());
  nodes_.emplace_back();
  build(0, leaves, 0, leaves.size());
}

void HullTree::build(std::uint32_t node, std::vector<Node>& leaves, std::size_t begin, std::size_t end)
{
  if (end - begin == 1)
  {
    nodes_[node] = leaves[begin];
    return;
  }
  const auto middle =
      splitAtMedian(leaves.begin() + static_cast<std::ptrdiff_t>(begin),
                    leaves.begin() + static_cast<std::ptrdiff_t>(end), [](const Node& leaf) { return leaf.center; });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  const auto split = static_cast<std::size_t>(middle - leaves.begin());
  build(child, leaves, begin, split);
  build(child + 1, leaves, split, end);
  std::vector<Eigen::Vector3d> points = nodes_[child].vertices;
  points.insert(points.end(), nodes_[child + 1].vertices.begin(), nodes_[child + 1].vertices.end());
  nodes_[node] = nodeOf(points, tolerance_);
  nodes_[node].child = child;
}
}  // namespace gpu_planning_scene::core::literature
