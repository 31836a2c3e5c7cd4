#pragma once

#include <cstdint>

namespace gpu_planning_scene::core
{
constexpr unsigned kWideSlots = 8;

/// Up to eight oriented boxes, as a structure of arrays: each array has one number of each box.
struct alignas(64) WideNode
{
  float axes[3][3][kWideSlots];  ///< [i][k]: coordinate k of axis i
  float center[3][kWideSlots];
  float half[3][kWideSlots];
  float radius[kWideSlots];          ///< half the diagonal, rounded up
  std::uint32_t below[kWideSlots];   ///< the node with the boxes below this box; 0: a leaf
  std::uint32_t source[kWideSlots];  ///< the node of the binary tree that has the same triangles
  std::uint32_t block[kWideSlots];   ///< leaves: the block of the leaf's triangles
  std::uint32_t boxes;
};

/// A box in the frame of a wide tree.
struct FloatBox
{
  float axes[3][3];  ///< [j][k]: coordinate k of axis j
  float center[3];
  float half[3];
};

/// Tests the boxes of a node against one box by their 15 possible separating axes (Gottschalk, Lin and Manocha,
/// "OBBTree", 1996). Bit i of the result is 0 only if box i and `box` do not overlap, provided that `box` was grown by
/// the rounding errors (see WidePlacement). Thread-safe.
using OverlapTest = unsigned (*)(const WideNode& node, const FloatBox& box);
}  // namespace gpu_planning_scene::core
