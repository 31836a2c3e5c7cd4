#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "collision/problem/collision_problem.h"
#include "collision/trees/cpu_tree.h"

namespace gpu_planning_scene::core
{
/// The trees of a collision problem. Immutable.
class CpuForest
{
 public:
  CpuForest() = default;
  explicit CpuForest(std::vector<std::shared_ptr<const CpuTree>> trees) : trees_(std::move(trees)) {}
  /// Builds only the trees that are not in use in this process. `previous`: the forest of an earlier scene, or null. A
  /// shape that has kept its number then keeps its tree without a search for it.
  explicit CpuForest(const CollisionProblem& problem, const CpuForest* previous = nullptr);
  /// `forest` must hold a valid tree for each of the problem's trees.
  CpuForest(const CollisionProblem& problem, const Forest& forest);

  const CpuTree& tree(std::uint32_t number) const { return *trees_[number]; }
  const std::shared_ptr<const CpuTree>& shared(std::uint32_t number) const { return trees_[number]; }

 private:
  std::vector<std::shared_ptr<const CpuTree>> trees_;
};
}  // namespace gpu_planning_scene::core
