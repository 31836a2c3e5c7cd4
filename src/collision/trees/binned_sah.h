#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "collision/trees/forest.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// A bounding volume hierarchy over boxes. Node 0 is the root. The entries first .. first + count - 1 of `order` hold
/// the numbers of a leaf's boxes.
struct BoxTree
{
  std::vector<Node> nodes;
  std::vector<std::uint32_t> order;
};

/// Builds a tree from the top with the binned surface area heuristic (Wald, "On fast Construction of SAH-based Bounding
/// Volume Hierarchies", 2007). The depth is at most 64 + log2(boxes). Without boxes the tree has no nodes.
BoxTree buildBinnedSah(const std::vector<Eigen::AlignedBox3d>& boxes, std::uint32_t max_leaf_size);

/// Sets the node's box to the smallest float box that contains `box`.
void setBox(const Eigen::AlignedBox3d& box, Node& node);

/// Builds a tree for each mesh in the same way, with leaves of at most kLeafTriangles. This builder serves machines
/// without a GL device, and it is the reference for the quality of the GPU's trees. Each mesh must have at least one
/// triangle.
Forest buildBinnedSah(const std::vector<Tessellation>& meshes);
}  // namespace gpu_planning_scene::core
