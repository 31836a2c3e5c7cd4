#pragma once

#include <memory>
#include <vector>

#include "collision/collision_problem.h"
#include "collision/cpu_forest.h"

namespace gpu_planning_scene
{
/// The trees of the last problem, for the next one with the same shapes.
class ForestCache
{
 public:
  std::shared_ptr<const CpuForest> forestOf(const CollisionProblem& problem);

 private:
  std::vector<Shape> shapes_;
  std::shared_ptr<const CpuForest> forest_;
};
}  // namespace gpu_planning_scene
