#include "collision/exact/forest_cache.h"

#include <utility>

namespace gpu_planning_scene::core
{
std::unique_ptr<const ExactChecker> ForestCache::exactCheckerOf(std::shared_ptr<const CollisionProblem> problem)
{
  forest_ = std::make_shared<const CpuForest>(*problem, forest_.get());
  objects_ = std::make_shared<const ObjectTree>(worldBounds(*problem, *forest_), objects_ ? *objects_ : ObjectTree());
  return std::make_unique<const ExactChecker>(std::move(problem), forest_, objects_);
}
}  // namespace gpu_planning_scene::core
