#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "collision/gpu/tree_build/gpu_forest.h"
#include "collision/gpu/tree_build/gpu_oriented_boxes.h"
#include "collision/trees/forest.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// The trees of a region as they lie in the memory of the device. Numbers of nodes and triangles count across all
/// regions.
struct BuiltTrees
{
  ForestRegion region;
  std::vector<Node> nodes;                // of the region, as the members below
  std::vector<OrientedNode> oriented;     // at the places of `nodes`
  std::vector<std::uint32_t> leaf_order;  // triangle numbers
  std::vector<float> corners;             // TRIANGLE_TEXELS texels of four floats a triangle, in leaf order
};

/// The first fault of the trees, in one line. Empty if each tree has each triangle of its mesh in exactly one leaf,
/// with the right corners, if all boxes contain the triangles below them, and if no leaf is deeper than the region
/// says. An oriented box is tested with up to four of its triangles.
std::string faultOf(const BuiltTrees& trees, const std::vector<const Mesh*>& meshes);
}  // namespace gpu_planning_scene::core
