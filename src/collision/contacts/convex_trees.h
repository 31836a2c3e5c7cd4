#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "collision/trees/cpu_forest.h"

namespace gpu_planning_scene::core
{
/// Answers of isConvexSolid for the trees that are in use. Thread-safe.
class KnownConvexity
{
 public:
  bool isConvex(const std::shared_ptr<const CpuTree>& tree);
  void forgetUnused();

 private:
  std::mutex mutex_;  // guards `convex_`
  std::map<std::weak_ptr<const CpuTree>, bool, std::owner_less<>> convex_;
};

/// The same for the trees of one forest, without a lock once a tree is known. Thread-safe.
class ConvexTrees
{
 public:
  ConvexTrees(std::shared_ptr<KnownConvexity> known, std::shared_ptr<const CpuForest> forest, std::size_t trees)
    : known_(std::move(known)), forest_(std::move(forest)), answers_(trees)
  {
  }

  bool isConvex(std::uint32_t tree) const;

 private:
  enum class Answer : std::uint8_t
  {
    Unknown,
    Convex,
    NotConvex
  };

  std::shared_ptr<KnownConvexity> known_;
  std::shared_ptr<const CpuForest> forest_;
  mutable std::vector<std::atomic<Answer>> answers_;  // one per tree
};
}  // namespace gpu_planning_scene::core
