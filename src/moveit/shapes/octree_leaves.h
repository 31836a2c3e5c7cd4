#pragma once

#include <octomap/OcTree.h>
#include <Eigen/Geometry>

namespace gpu_planning_scene::detector
{
/// Visits the nodes of an octree from the root, as they are now. The root's cube is centred at the octree's origin.
/// enters(box) tells whether to visit what lies below a node; visit(centre, depth) is called for each occupied leaf
/// that was entered, until it returns true. Returns whether visit returned true. The occupancy of inner nodes is not
/// used, because it may be older than that of the leaves.
template <class Enters, class Visit>
bool visitOccupiedLeaves(const octomap::OcTree& octree, const octomap::OcTreeNode* node, const Eigen::Vector3d& center,
                         double half, unsigned depth, const Enters& enters, const Visit& visit)
{
  const Eigen::AlignedBox3d box(center.array() - half, center.array() + half);
  if (!enters(box))
    return false;
  if (!octree.nodeHasChildren(node))
    return octree.isNodeOccupied(node) && visit(center, depth);
  for (unsigned i = 0; i < 8; ++i)
  {
    if (!octree.nodeChildExists(node, i))
      continue;
    const double quarter = 0.5 * half;
    const Eigen::Vector3d child(center.x() + ((i & 1u) != 0 ? quarter : -quarter),
                                center.y() + ((i & 2u) != 0 ? quarter : -quarter),
                                center.z() + ((i & 4u) != 0 ? quarter : -quarter));
    if (visitOccupiedLeaves(octree, octree.getNodeChild(node, i), child, quarter, depth + 1, enters, visit))
      return true;
  }
  return false;
}

template <class Enters, class Visit>
bool visitOccupiedLeaves(const octomap::OcTree& octree, const Enters& enters, const Visit& visit)
{
  const octomap::OcTreeNode* root = octree.getRoot();
  return root &&
         visitOccupiedLeaves(octree, root, Eigen::Vector3d::Zero(), 0.5 * octree.getNodeSize(0), 0, enters, visit);
}
}  // namespace gpu_planning_scene::detector
