#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "collision/geometry/oriented_box.h"
#include "collision/geometry/triangle_pair.h"
#include "collision/trees/wide_overlap.h"
#include "collision/trees/wide_triangles.h"

namespace gpu_planning_scene::core
{
struct CpuNode;

/// The number of a box in a wide tree.
using BoxIndex = std::uint32_t;

/// A tree of oriented boxes in which a node has up to eight boxes, for a test of all of them at a time (wide bounding
/// volume hierarchy; Dammertz, Hanika and Keller, "Shallow Bounding Volume Hierarchies", 2008). The numbers of a box
/// are floats relative to `origin`, so a box contains its triangles only up to rounding. To make up for this,
/// WidePlacement adds the rounding errors to the required distance of each comparison.
class WideTree
{
 public:
  WideTree() = default;
  /// Collapses a binary tree over `triangles`; its node 0 is the root.
  WideTree(const std::vector<CpuNode>& nodes, const std::vector<Triangle>& triangles, const Eigen::Vector3d& origin);

  /// The box around the whole tree.
  static constexpr BoxIndex kRoot = 0;

  bool isLeaf(BoxIndex box) const { return node(box).below[slot(box)] == 0; }
  /// The node of the binary tree that has the same triangles.
  std::uint32_t source(BoxIndex box) const { return node(box).source[slot(box)]; }
  /// The triangles of a leaf, relative to `origin`.
  const TriangleBlock& triangles(BoxIndex leaf) const { return blocks_[node(leaf).block[slot(leaf)]]; }
  /// The node with the boxes directly below an inner box.
  const WideNode& below(BoxIndex inner) const { return nodes_[node(inner).below[slot(inner)]]; }
  /// Box `slot` of the node below an inner box.
  BoxIndex child(BoxIndex inner, unsigned slot) const
  {
    return kWideSlots * node(inner).below[this->slot(inner)] + slot;
  }

  /// Half the diagonal, rounded up.
  float radius(BoxIndex box) const { return node(box).radius[slot(box)]; }
  Eigen::Vector3d center(BoxIndex box) const;  ///< in the frame of the shape; see centerError
  const WideNode& node(BoxIndex box) const { return nodes_[box / kWideSlots]; }
  static unsigned slot(BoxIndex box) { return box % kWideSlots; }

  const Eigen::Vector3d& origin() const { return origin_; }
  /// No corner of a box is farther from the origin.
  double reach() const { return reach_; }
  /// The centre of a box is rounded to floats, by less than this distance.
  double centerError() const { return std::numeric_limits<float>::epsilon() * reach_; }

 private:
  std::vector<WideNode> nodes_;  // node 0 has one box, the root
  std::vector<TriangleBlock> blocks_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double reach_ = 0.0;
};

/// Whether a traversal opens the first box of a pair rather than the second. It opens the larger one, unless that one
/// is a leaf. At most one of the two may be a leaf.
inline bool opensFirst(const WideTree& tree_a, BoxIndex a, const WideTree& tree_b, BoxIndex b)
{
  return tree_b.isLeaf(b) || (!tree_a.isLeaf(a) && tree_a.radius(a) >= tree_b.radius(b));
}

/// The lowest bit that is set. `bits`: not 0.
inline unsigned lowestBit(unsigned bits)
{
  return static_cast<unsigned>(__builtin_ctz(bits));
}

/// Places boxes and triangles of one wide tree in the frame of another tree, as floats. Their distance is `required`
/// plus the rounding errors of both trees and of the tests (docs/error_bounds.md, "Wide trees").
class WidePlacement
{
 public:
  /// For boxes of `from`, at the pose `from_in_to`, in the frame of `to`. `required`: metres.
  WidePlacement(const WideTree& from, const Eigen::Isometry3d& from_in_to, const WideTree& to, double required);

  FloatBox place(const WideTree& from, BoxIndex box) const;
  TriangleBlock place(const TriangleBlock& block) const;
  /// `required` plus the rounding errors.
  float distance() const { return distance_; }
  double errors() const { return errors_; }  ///< see floatErrors

 private:
  float rotation_[3][3];  // rows
  float translation_[3];
  double errors_;
  float distance_;
  bool has_long_distance_;
};

/// A box in the frame of `tree`'s shape, as floats relative to the tree's origin, with a distance as by WidePlacement.
FloatBox floatBox(const OrientedBox& box, const WideTree& tree, double required);

/// The rounding errors that WidePlacement and floatBox add to the required distance. `distance`: of the origins.
/// `reaches`: the sum of both reaches.
double floatErrors(double distance, double reaches, double required);
}  // namespace gpu_planning_scene::core
