#include "support/kept_trees.h"

#include <vector>

#include "collision/bounds/problem_maker.h"
#include "collision/trees/cpu_forest.h"

namespace gpu_planning_scene::core
{
void keepTrees(const PlanningScene& scene)
{
  static std::vector<CpuForest> kept;
  kept.emplace_back(makeProblem(scene, "", nullptr));
}
}  // namespace gpu_planning_scene::core
