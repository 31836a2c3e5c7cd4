#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
using MeshPtr = std::shared_ptr<const Mesh>;

/// The tree of a mesh: made once, and shared by all pairs with this mesh while one of them exists. Thread-safe.
template <class Tree>
std::shared_ptr<const Tree> sharedTree(const MeshPtr& mesh)
{
  static std::mutex mutex;
  static std::map<const Mesh*, std::weak_ptr<const Tree>> kept;
  const std::lock_guard<std::mutex> lock(mutex);
  std::weak_ptr<const Tree>& entry = kept[mesh.get()];
  std::shared_ptr<const Tree> tree = entry.lock();
  if (!tree)
  {
    // The tree holds its mesh, so that no other mesh gets the same address.
    struct Held
    {
      MeshPtr mesh;
      Tree tree;
    };
    const auto held = std::make_shared<const Held>(Held{mesh, Tree(*mesh)});
    tree = std::shared_ptr<const Tree>(held, &held->tree);
    entry = tree;
  }
  return tree;
}
}  // namespace gpu_planning_scene::core::literature
