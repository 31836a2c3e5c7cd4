#include "collision/exact/cpu_forest.h"

namespace gpu_planning_scene::core
{
CpuForest::CpuForest(const CollisionProblem& problem)
{
  trees_.reserve(problem.shapes.size());
  for (std::size_t i = 0; i < problem.shapes.size(); ++i)
    trees_.push_back(cpuTreeOf(problem.shapes[i], problem.tessellations[i]));
}

CpuForest::CpuForest(const CollisionProblem& problem, const Forest& forest)
{
  trees_.reserve(problem.shapes.size());
  for (std::size_t i = 0; i < problem.shapes.size(); ++i)
    trees_.push_back(makeCpuTree(problem.shapes[i], *problem.tessellations[i].mesh, forest, i));
}
}  // namespace gpu_planning_scene::core
