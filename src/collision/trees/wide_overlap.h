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

/// A box in the frame of a wide tree, grown on all sides by the distance within which other boxes count as overlapping.
struct FloatBox
{
  float axes[3][3];  ///< [j][k]: coordinate k of axis j
  float center[3];
  float half[3];           ///< grown
  float distance;          ///< metres: the required distance plus the rounding errors (see WidePlacement)
  bool has_long_distance;  ///< the required distance exceeds the rounding errors
};

/// Tests the boxes of a node against one box by their 15 possible separating axes (Gottschalk, Lin and Manocha,
/// "OBBTree", 1996). The corners of a grown box are farther from the box than the distance. So boxes with a long
/// distance are also tested before they are grown, along the faces of box i and along the line of the two centres. Bit
/// i of the result is 0 only if box i and `box` are farther apart than the required distance. Thread-safe.
using OverlapTest = unsigned (*)(const WideNode& node, const FloatBox& box);
}  // namespace gpu_planning_scene::core
