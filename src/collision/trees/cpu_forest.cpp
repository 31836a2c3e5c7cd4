#include "collision/trees/cpu_forest.h"

namespace gpu_planning_scene::core
{
CpuForest::CpuForest(const CollisionProblem& problem, const CpuForest* previous)
{
  trees_.reserve(problem.shapes.size());
  for (std::size_t i = 0; i < problem.shapes.size(); ++i)
  {
    const Shape& shape = problem.shapes[i];
    const bool is_kept = previous && i < previous->trees_.size() && sameShape(previous->trees_[i]->shape, shape);
    trees_.push_back(is_kept ? previous->trees_[i] : cpuTreeOf(shape, problem.tessellations[i]));
  }
}

CpuForest::CpuForest(const CollisionProblem& problem, const Forest& forest)
{
  trees_.reserve(problem.shapes.size());
  for (std::size_t i = 0; i < problem.shapes.size(); ++i)
    trees_.push_back(makeCpuTree(problem.shapes[i], problem.tessellations[i], forest, i));
}
}  // namespace gpu_planning_scene::core
