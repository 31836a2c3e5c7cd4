#include "collision/trees/binned_sah.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

// Top-down build of a bounding volume hierarchy. Each node sorts the centres of its items into bins along each axis and
// is split between two bins where the surface area heuristic predicts the least cost (Wald 2007).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr int kMaxBins = 32;
constexpr int kMaxSahDepth = 64;    // deeper nodes are split into halves of equal count, which bounds the depth
constexpr double kVisitCost = 1.5;  // cost of visiting a node, relative to the cost of a leaf's item

double area(const AlignedBox3d& box)
{
  if (box.isEmpty())
    return 0.0;
  const Vector3d d = box.sizes();
  return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
}

struct Split
{
  double cost = std::numeric_limits<double>::infinity();
  int axis = -1;
  int bin = 0;  // the items of bins 0 .. bin go to the first child
};

class Builder
{
 public:
  Builder(const std::vector<AlignedBox3d>& boxes, std::uint32_t max_leaf_size)
    : boxes_(boxes), max_leaf_size_(max_leaf_size)
  {
    tree_.order.resize(boxes.size());
    std::iota(tree_.order.begin(), tree_.order.end(), 0u);
  }

  BoxTree build()
  {
    if (!boxes_.empty())
    {
      tree_.nodes.reserve(2 * boxes_.size());
      tree_.nodes.emplace_back();
      buildNode(0, 0, static_cast<std::uint32_t>(boxes_.size()), 0);
    }
    return std::move(tree_);
  }

 private:
  void buildNode(std::uint32_t node, std::uint32_t begin, std::uint32_t end, int depth)
  {
    AlignedBox3d bounds;
    AlignedBox3d centers;
    for (std::uint32_t i = begin; i < end; ++i)
    {
      bounds.extend(boxes_[tree_.order[i]]);
      centers.extend(boxes_[tree_.order[i]].center());
    }
    setBox(bounds, tree_.nodes[node]);

    const std::uint32_t count = end - begin;
    const Split split = count > 1 && depth < kMaxSahDepth ? bestSplit(begin, end, centers) : Split();
    const double split_cost = kVisitCost * area(bounds) + split.cost;
    if (count == 1 || (count <= max_leaf_size_ && count * area(bounds) <= split_cost))
    {
      tree_.nodes[node].first = begin;
      tree_.nodes[node].count = count;
      return;
    }
    std::uint32_t middle = begin + count / 2;
    if (split.axis >= 0)
    {
      const auto first = tree_.order.begin();
      middle = static_cast<std::uint32_t>(
          std::partition(first + begin, first + end,
                         [&](std::uint32_t item)
                         { return binOf(item, split.axis, binsFor(count), centers) <= split.bin; }) -
          first);
    }
    const std::uint32_t child = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.resize(child + 2);
    tree_.nodes[node].first = child;
    tree_.nodes[node].count = 0;
    buildNode(child, begin, middle, depth + 1);
    buildNode(child + 1, middle, end, depth + 1);
  }

  /// Most nodes have few items, and more bins than twice the items would hardly separate more of them.
  static int binsFor(std::uint32_t count) { return count < kMaxBins / 2 ? 2 * static_cast<int>(count) : kMaxBins; }

  int binOf(std::uint32_t item, int axis, int bins, const AlignedBox3d& centers) const
  {
    const double extent = centers.max()[axis] - centers.min()[axis];
    const double offset = boxes_[item].center()[axis] - centers.min()[axis];
    return static_cast<int>(std::clamp(bins * (offset / extent), 0.0, bins - 1.0));
  }

  Split bestSplit(std::uint32_t begin, std::uint32_t end, const AlignedBox3d& centers) const
  {
    Split best;
    const int bins = binsFor(end - begin);
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!(centers.max()[axis] > centers.min()[axis]))
        continue;
      std::array<AlignedBox3d, kMaxBins> bounds;
      std::array<std::uint32_t, kMaxBins> counts = {};
      for (std::uint32_t i = begin; i < end; ++i)
      {
        const int bin = binOf(tree_.order[i], axis, bins, centers);
        bounds[bin].extend(boxes_[tree_.order[i]]);
        ++counts[bin];
      }
      std::array<double, kMaxBins> upper_costs;  // cost of all bins from this one on
      AlignedBox3d upper;
      std::uint32_t upper_count = 0;
      for (int bin = bins - 1; bin > 0; --bin)
      {
        upper.extend(bounds[bin]);
        upper_count += counts[bin];
        upper_costs[bin] = area(upper) * upper_count;
      }
      AlignedBox3d lower;
      std::uint32_t lower_count = 0;
      for (int bin = 0; bin + 1 < bins; ++bin)
      {
        lower.extend(bounds[bin]);
        lower_count += counts[bin];
        const double cost = area(lower) * lower_count + upper_costs[bin + 1];
        if (lower_count > 0 && lower_count < end - begin && cost < best.cost)
          best = {cost, axis, bin};
      }
    }
    return best;
  }

  const std::vector<AlignedBox3d>& boxes_;
  const std::uint32_t max_leaf_size_;
  BoxTree tree_;
};
}  // namespace

/// The centre is rounded to float, so the half lengths must reach both ends of the box from the rounded centre.
void setBox(const AlignedBox3d& box, Node& node)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double lower = box.min()[axis];
    const double upper = box.max()[axis];
    const float center = static_cast<float>(0.5 * (lower + upper));
    const double reach = std::max(upper - center, center - lower);
    float half = static_cast<float>(reach);
    while (static_cast<double>(center) + half < upper || static_cast<double>(center) - half > lower)
      half = std::nextafter(half, std::numeric_limits<float>::infinity());
    node.center[axis] = center;
    node.half[axis] = half;
  }
}

BoxTree buildBinnedSah(const std::vector<AlignedBox3d>& boxes, std::uint32_t max_leaf_size)
{
  return Builder(boxes, max_leaf_size).build();
}

Forest buildBinnedSah(const std::vector<Tessellation>& meshes)
{
  Forest forest;
  std::uint32_t first_triangle = 0;
  for (const Tessellation& tessellation : meshes)
  {
    const Mesh& mesh = *tessellation.mesh;
    std::vector<AlignedBox3d> boxes(mesh.triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t)
      for (const std::uint32_t vertex : mesh.triangles[t])
        boxes[t].extend(mesh.vertices[vertex]);
    const BoxTree tree = buildBinnedSah(boxes, kLeafTriangles);
    const auto first_node = static_cast<std::uint32_t>(forest.nodes.size());
    const auto first_leaf_triangle = static_cast<std::uint32_t>(forest.leaf_triangles.size());
    forest.roots.push_back(first_node);
    forest.first_triangle.push_back(first_triangle);
    for (Node node : tree.nodes)
    {
      node.first += node.count == 0 ? first_node : first_leaf_triangle;
      forest.nodes.push_back(node);
    }
    for (const std::uint32_t triangle : tree.order)
      forest.leaf_triangles.push_back(first_triangle + triangle);
    first_triangle += static_cast<std::uint32_t>(mesh.triangles.size());
  }
  return forest;
}
}  // namespace gpu_planning_scene::core
