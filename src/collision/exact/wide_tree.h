#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/wide_overlap.h"
#include "collision/geometry/oriented_box.h"

namespace gpu_planning_scene::core
{
struct CpuNode;

/// One of the boxes of a wide tree.
using WideBox = std::uint32_t;

/// A tree of oriented boxes in which a node has up to eight boxes, for a test of all of them at a time (wide bounding
/// volume hierarchy; Dammertz, Hanika and Keller, "Shallow Bounding Volume Hierarchies", 2008). The boxes are floats
/// relative to `origin`, so they contain their triangles only up to rounding: FloatFrame grows the boxes that they are
/// compared with.
class WideTree
{
 public:
  WideTree() = default;
  /// Joins the nodes of a binary tree; node 0 is its root.
  WideTree(const std::vector<CpuNode>& nodes, const Eigen::Vector3d& origin);

  /// The box around the whole tree.
  static constexpr WideBox kRoot = 0;

  bool isLeaf(WideBox box) const { return node(box).count[slot(box)] != 0; }
  std::uint32_t firstTriangle(WideBox leaf) const { return node(leaf).first[slot(leaf)]; }
  std::uint32_t triangleCount(WideBox leaf) const { return node(leaf).count[slot(leaf)]; }
  /// The node with the boxes directly below an inner box.
  const WideNode& below(WideBox inner) const { return nodes_[node(inner).first[slot(inner)]]; }
  /// Box `slot` of the node below an inner box.
  WideBox child(WideBox inner, unsigned slot) const { return kWideSlots * node(inner).first[this->slot(inner)] + slot; }

  /// Half the diagonal, rounded up.
  float radius(WideBox box) const { return node(box).radius[slot(box)]; }
  Eigen::Vector3d center(WideBox box) const;  ///< in the frame of the shape; see centerError
  const WideNode& node(WideBox box) const { return nodes_[box / kWideSlots]; }
  static unsigned slot(WideBox box) { return box % kWideSlots; }

  const Eigen::Vector3d& origin() const { return origin_; }
  /// No corner of a box is farther from the origin.
  double reach() const { return reach_; }
  /// The centre of a box is rounded to floats, by at most this distance: half a unit in the last place of each of three
  /// coordinates.
  double centerError() const { return std::numeric_limits<float>::epsilon() * reach_; }

 private:
  std::vector<WideNode> nodes_;  // node 0 has one box, the root
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double reach_ = 0.0;
};

/// Places boxes of one wide tree in the frame of another tree, as floats. The boxes are grown by the rounding errors of
/// both trees and of the overlap test (docs/error_bounds.md, "Wide trees").
class FloatFrame
{
 public:
  /// Boxes of `from`, at the pose `from_in_to`, in the frame of `to`, grown by `growth` metres on all sides.
  FloatFrame(const WideTree& from, const Eigen::Isometry3d& from_in_to, const WideTree& to, double growth);

  FloatBox place(const WideTree& from, WideBox box) const;

 private:
  float rotation_[3][3];  // rows
  float translation_[3];
  float growth_;
};

/// A box in the frame of `tree`'s shape, as floats relative to the tree's origin, grown as by FloatFrame.
FloatBox floatBox(const OrientedBox& box, const WideTree& tree, double growth);
}  // namespace gpu_planning_scene::core
