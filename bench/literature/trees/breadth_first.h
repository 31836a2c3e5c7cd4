#pragma once

#include <memory>
#include <vector>

#include "literature/trees/oriented_boxes.h"

namespace gpu_planning_scene::core::literature
{
std::unique_ptr<Method> makeBreadthFirst(const MeshPtr& a, const MeshPtr& b, Search search);

/// A node's box in the frame of its mesh.
struct PlacedBox
{
  Eigen::Matrix3d rotation;
  Eigen::Vector3d center;
};
/// The boxes of all nodes, in their order.
std::vector<PlacedBox> placedBoxes(const OrientedBoxTree& tree);
}  // namespace gpu_planning_scene::core::literature
