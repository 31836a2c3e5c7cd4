#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/forest.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// A tree over boxes: a leaf's first .. first + count index `order`, which holds the numbers of the boxes. The root is
/// node 0.
struct BoxTree
{
  std::vector<Node> nodes;
  std::vector<std::uint32_t> order;
};

/// Top-down build with binned surface area heuristic, after Wald, "On fast Construction of SAH-based Bounding Volume
/// Hierarchies" (2007). Depth is bounded by 64 + log2(boxes). No boxes: no nodes.
BoxTree buildBinnedSah(const std::vector<Eigen::AlignedBox3d>& boxes, std::uint32_t max_leaf_size);

/// The smallest float box of a node that holds `box`.
void setBox(const Eigen::AlignedBox3d& box, Node& node);

/// A tree per mesh with that build, leaves of up to kLeafTriangles. The builder where there is no GL device, and the
/// yardstick for the trees that the GPU builds. Every mesh has at least one triangle.
Forest buildBinnedSah(const std::vector<Tessellation>& meshes);
}  // namespace gpu_planning_scene::core
