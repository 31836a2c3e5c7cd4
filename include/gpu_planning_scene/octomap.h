#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The id of the world object that an octomap becomes, as in MoveIt. An object of this id has one cube per occupied
/// leaf. A change (applyChange) cannot move or attach it. If a change removes it, its colour and its entries in the
/// allowed collision matrix stay. (A full scene replaces the colours and the matrix of the scene.) Other objects cannot
/// have this id.
inline const std::string kOctomapId = "<octomap>";

/// A serialised octree of liboctomap, as in octomap_msgs/Octomap.
struct SerializedOctree
{
  std::string id = "OcTree";  ///< the class of the octree: OcTree or ColorOcTree
  bool binary = true;         ///< each leaf is occupied or free (.bt); else each has an occupancy probability (.ot)
  double resolution = 0.0;    ///< metres: edge length of the smallest leaves
  std::vector<std::int8_t> bytes;  ///< the data of the file without its header
};

/// The occupied leaves of an octree at all depths, as cubes in the frame of the octree, in the order of the data. The
/// occupancy of inner nodes is not used. Empty data have no leaves. Throws Error for data that are not an octree, and
/// for more than `max_leaves` occupied leaves (0: for any occupied leaf). Data that are not an octree use no more time
/// and memory than an octree of the same size.
std::vector<PlacedShape> occupiedLeaves(const SerializedOctree& octree, std::size_t max_leaves);

/// The octree whose occupied leaves are these cubes, in the binary form. Its resolution is the edge length of the
/// smallest cube. It has no free leaves. Throws Error if the shapes are not the leaves of an octree.
SerializedOctree octreeOf(const std::vector<PlacedShape>& cubes);

/// Reads a .bt or .ot file of liboctomap. Throws Error that begins with the path.
SerializedOctree loadOctreeFile(const std::string& path);
}  // namespace gpu_planning_scene::core
