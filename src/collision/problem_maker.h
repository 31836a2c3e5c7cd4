#pragma once

#include <string>

#include "collision/collision_problem.h"
#include "collision/fixed_pairs.h"
#include "collision/pair_reducer.h"
#include "scene/validate_scene.h"

namespace gpu_planning_scene
{
/// Makes problems of scenes, one after the other, without what the reductions leave out. What it learns of a robot and
/// its meshes is kept for the next scene.
class ProblemMaker
{
 public:
  /// Throws Error for a negative tolerance, or one that is not finite.
  explicit ProblemMaker(const CheckerOptions& options);

  /// As makeProblem. Where Reductions::reach left pairs out, the problem holds for states within its ranges only.
  CollisionProblem make(const PlanningScene& scene, const std::string& group, SceneReport* report);

 private:
  CheckerOptions options_;
  SceneValidator validator_;
  PairReducer reducer_;
  TessellationCache tessellations_;
  FixedPairs fixed_pairs_;
};
}  // namespace gpu_planning_scene
