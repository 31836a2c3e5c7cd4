#pragma once

#include <memory>

#include "collision/exact/exact_checker.h"
#include "collision/problem/collision_problem.h"
#include "collision/trees/cpu_forest.h"
#include "collision/trees/object_tree.h"

namespace gpu_planning_scene::core
{
/// Keeps the CPU's trees for the next problem. Only the trees of new shapes are built, and the tree over objects is
/// refitted.
class ForestCache
{
 public:
  std::unique_ptr<const ExactChecker> exactCheckerOf(std::shared_ptr<const CollisionProblem> problem);

  /// The trees of the last checker; null before the first one.
  const std::shared_ptr<const CpuForest>& forest() const { return forest_; }
  const std::shared_ptr<const ObjectTree>& objects() const { return objects_; }

 private:
  std::shared_ptr<const CpuForest> forest_;
  std::shared_ptr<const ObjectTree> objects_;
};
}  // namespace gpu_planning_scene::core
