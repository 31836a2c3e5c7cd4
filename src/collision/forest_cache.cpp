#include "collision/forest_cache.h"

#include <algorithm>

#include "collision/binned_sah.h"

namespace gpu_planning_scene
{
std::shared_ptr<const CpuForest> ForestCache::forestOf(const CollisionProblem& problem)
{
  const std::vector<Shape>& shapes = problem.shapes;
  if (!forest_ || !std::equal(shapes_.begin(), shapes_.end(), shapes.begin(), shapes.end(), sameShape))
  {
    forest_ = std::make_shared<const CpuForest>(problem, std::make_shared<const Forest>(buildBinnedSah(problem.trees)));
    shapes_ = shapes;
  }
  return forest_;
}
}  // namespace gpu_planning_scene
