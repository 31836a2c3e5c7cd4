#pragma once

#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>

#include "gpu_planning_scene/solids.h"

namespace gpu_planning_scene::core
{
/// The solids of this process that someone holds, by the address of their original mesh.
class SolidRegistry
{
 public:
  std::shared_ptr<const SolidMesh> find(const std::shared_ptr<const Mesh>& mesh)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = entries_.find(mesh.get());
    // Another mesh may have had the same address.
    return found == entries_.end() || found->second.original.lock() != mesh ? nullptr : found->second.solid.lock();
  }

  void add(const std::shared_ptr<const Mesh>& mesh, const std::shared_ptr<const SolidMesh>& solid)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (entries_.size() > 2 * size_when_cleared_ + kFewEntries)
    {
      for (auto entry = entries_.begin(); entry != entries_.end();)
        entry = entry->second.solid.expired() ? entries_.erase(entry) : std::next(entry);
      size_when_cleared_ = entries_.size();
    }
    entries_[mesh.get()] = {mesh, solid};
  }

 private:
  static constexpr std::size_t kFewEntries = 1024;
  struct Entry
  {
    std::weak_ptr<const Mesh> original;
    std::weak_ptr<const SolidMesh> solid;
  };

  std::mutex mutex_;  // guards the members below; not held while a mesh is closed
  std::map<const Mesh*, Entry> entries_;
  std::size_t size_when_cleared_ = 0;
};
}  // namespace gpu_planning_scene::core
