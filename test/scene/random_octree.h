#pragma once

#include <cstdint>
#include <random>
#include <sstream>
#include <string>

#ifndef OCTOMAP_NODEBUGOUT
#define OCTOMAP_NODEBUGOUT  // liboctomap prints progress if NDEBUG is not defined
#endif
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include "gpu_planning_scene/octomap.h"

namespace gpu_planning_scene::core
{
/// Fills an octree with occupied and free leaves at several depths, within `reach` metres of the origin. liboctomap
/// makes the larger leaves by pruning.
template <class Tree>
void fillAtRandom(Tree& tree, double reach, int leaves, std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> place(-reach, reach);
  std::uniform_int_distribution<int> small(0, 3);
  for (int i = 0; i < leaves; ++i)
  {
    const octomap::point3d low(static_cast<float>(place(generator)), static_cast<float>(place(generator)),
                               static_cast<float>(place(generator)));
    const bool occupied = small(generator) != 0;
    octomap::OcTreeKey key;
    if (!tree.coordToKeyChecked(low, key))
      continue;
    // A block that is aligned to its size becomes one leaf when the tree is pruned.
    const auto size = static_cast<std::uint16_t>(1U << static_cast<unsigned>(small(generator)));
    for (octomap::key_type x = 0; x < size; ++x)
      for (octomap::key_type y = 0; y < size; ++y)
        for (octomap::key_type z = 0; z < size; ++z)
          tree.setNodeValue(octomap::OcTreeKey(static_cast<octomap::key_type>(key[0] / size * size + x),
                                               static_cast<octomap::key_type>(key[1] / size * size + y),
                                               static_cast<octomap::key_type>(key[2] / size * size + z)),
                            occupied ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog());
  }
  tree.updateInnerOccupancy();
  tree.prune();
}

/// The octree as liboctomap writes it.
template <class Tree>
SerializedOctree serialized(const Tree& tree, bool binary)
{
  std::stringstream stream;
  if (binary)
    tree.writeBinaryData(stream);
  else
    tree.writeData(stream);
  const std::string bytes = stream.str();
  return {tree.getTreeType(), binary, tree.getResolution(), {bytes.begin(), bytes.end()}};
}
}  // namespace gpu_planning_scene::core
