#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "collision/geometry/triangle_pair.h"
#include "gpu_planning_scene/error.h"
#include "volumes/boxes_and_spheres.h"
#include "volumes/pairs.h"

namespace gpu_planning_scene::core::volumes
{
/// Selects which of two overlapping nodes is replaced by its children. A leaf is never replaced.
enum class DescentRule
{
  Larger,     ///< the larger by size()
  Shallower,  ///< the node nearer to its root
  Both
};

/// Fits a volume to each node of all trees. Throws Error if a volume does not contain its node's triangles.
template <class Volume>
std::vector<std::vector<Volume>> fitVolumes(const PlacedPairs& placed)
{
  std::vector<std::vector<Volume>> volumes(placed.trees);
  for (std::uint32_t number = 0; number < placed.trees; ++number)
  {
    const CpuTree& tree = placed.forest.tree(number);
    Eigen::Matrix3Xd corners(3, 3 * tree.triangles.size());
    for (std::size_t i = 0; i < tree.triangles.size(); ++i)
      for (int k = 0; k < 3; ++k)
        corners.col(static_cast<Eigen::Index>(3 * i) + k) = tree.triangles[i][k];
    // Trees are laid out depth first, so the triangles of a node are contiguous and children come after their parents.
    std::vector<std::array<std::uint32_t, 2>> ranges(tree.nodes.size());
    for (std::size_t i = tree.nodes.size(); i-- > 0;)
    {
      const CpuNode& node = tree.nodes[i];
      if (node.count != 0)
        ranges[i] = {node.first, node.first + node.count};
      else
        ranges[i] = {ranges[node.first][0], ranges[node.first + 1][1]};
    }
    for (const auto& [begin, end] : ranges)
    {
      const Points points = corners.middleCols(3 * begin, 3 * (end - begin));
      volumes[number].push_back(Volume::fit(points));
      for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (!volumes[number].back().contains(points.col(i)))
          throw Error("tree " + std::to_string(number) + ": a volume does not hold its node's triangles; mend its fit");
    }
  }
  return volumes;
}

/// Traverses pairs of bounding volume trees for the pairs of a state, depth first or breadth-first (level by level, as
/// in Gress and Zachmann 2003), with one kind of volume. Reuses its buffers for all states.
template <class Volume>
class Traversal
{
 public:
  Traversal(const PlacedPairs& placed, const std::vector<std::vector<Volume>>& volumes, DescentRule descent_rule)
    : placed_(placed), volumes_(volumes), descent_rule_(descent_rule)
  {
  }

  /// Traverses one pair after another, each depth first, up to the first hit. Returns the index of the colliding pair
  /// within the state, or -1.
  template <class Count>
  int depthFirst(std::size_t state, Count& count)
  {
    const std::size_t begin = placed_.first[state];
    for (std::size_t i = begin; i < placed_.first[state + 1]; ++i)
      if (meet(placed_.pairs[i], count))
        return static_cast<int>(i - begin);
    return -1;
  }

  /// Traverses all pairs of the state level by level, as on the GPU. Stops after the first level with a hit. Returns
  /// whether there is a hit.
  template <class Count>
  bool breadthFirst(std::size_t state, Count& count)
  {
    const PlacedPair* pairs = placed_.pairs.data() + placed_.first[state];
    const std::size_t number = placed_.first[state + 1] - placed_.first[state];
    tests_.clear();
    list_.clear();
    for (std::uint32_t i = 0; i < number; ++i)
    {
      tests_.emplace_back(pairs[i].b_in_a);
      list_.push_back({0, 0, i});
    }
    bool hit = false;
    for (std::uint32_t level = 0; !list_.empty() && !hit; ++level)
    {
      next_.clear();
      for (const Item& item : list_)
      {
        const auto push = [&](std::uint32_t a, std::uint32_t b) { next_.push_back({a, b, item.tag}); };
        hit = visit(pairs[item.tag], tests_[item.tag], item, level, count, push) || hit;
      }
      list_.swap(next_);
    }
    return hit;
  }

 private:
  struct Item
  {
    std::uint32_t a;  // nodes
    std::uint32_t b;
    std::uint32_t tag;  // depth first: the level; breadth-first: the pair
  };

  template <class Count>
  bool meet(const PlacedPair& pair, Count& count)
  {
    const typename Volume::Test test(pair.b_in_a);
    list_.assign(1, {0, 0, 0});
    while (!list_.empty())
    {
      const Item item = list_.back();
      list_.pop_back();
      const auto push = [&](std::uint32_t a, std::uint32_t b) { list_.push_back({a, b, item.tag + 1}); };
      if (visit(pair, test, item, item.tag, count, push))
        return true;
    }
    return false;
  }

  /// Tests a pair of nodes. Returns whether two leaves collide. If other nodes overlap, calls push(a, b) for each pair
  /// of children.
  template <class Count, class Push>
  bool visit(const PlacedPair& pair, const typename Volume::Test& test, const Item& item, std::size_t level,
             Count& count, const Push& push) const
  {
    const Volume& volume_a = volumes_[pair.a][item.a];
    const Volume& volume_b = volumes_[pair.b][item.b];
    const bool overlap = test.overlap(volume_a, volume_b);
    count.test(level, overlap);
    if (!overlap)
      return false;
    const CpuTree& tree_a = placed_.forest.tree(pair.a);
    const CpuTree& tree_b = placed_.forest.tree(pair.b);
    const CpuNode& a = tree_a.nodes[item.a];
    const CpuNode& b = tree_b.nodes[item.b];
    bool open_a = a.count == 0;
    bool open_b = b.count == 0;
    if (!open_a && !open_b)
      return leavesMeet(tree_a, a, tree_b, b, pair.b_in_a, level, count);
    if (open_a && open_b && descent_rule_ != DescentRule::Both)
    {
      open_a = descent_rule_ == DescentRule::Larger ? volume_a.size() >= volume_b.size()
                                                    : placed_.depths[pair.a][item.a] <= placed_.depths[pair.b][item.b];
      open_b = !open_a;
    }
    for (std::uint32_t i = 0; i < (open_a ? 2U : 1U); ++i)
      for (std::uint32_t j = 0; j < (open_b ? 2U : 1U); ++j)
        push(open_a ? a.first + i : item.a, open_b ? b.first + j : item.b);
    return false;
  }

  template <class Count>
  static bool leavesMeet(const CpuTree& tree_a, const CpuNode& a, const CpuTree& tree_b, const CpuNode& b,
                         const Eigen::Isometry3d& b_in_a, std::size_t level, Count& count)
  {
    count.leafPair(level);
    for (std::uint32_t j = b.first; j < b.first + b.count; ++j)
    {
      const Triangle& t = tree_b.triangles[j];
      const Triangle triangle_b = {b_in_a * t[0], b_in_a * t[1], b_in_a * t[2]};
      for (std::uint32_t i = a.first; i < a.first + a.count; ++i)
      {
        count.trianglePair(level);
        if (trianglesWithin(tree_a.triangles[i], triangle_b, 0.0))
          return true;
      }
    }
    return false;
  }

  const PlacedPairs& placed_;
  const std::vector<std::vector<Volume>>& volumes_;
  DescentRule descent_rule_;
  std::vector<typename Volume::Test> tests_;  // breadth-first: one per pair
  std::vector<Item> list_;
  std::vector<Item> next_;
};
}  // namespace gpu_planning_scene::core::volumes
