#pragma once

#include <string>

#include "collision/bounds/reachability_filter.h"
#include "collision/bounds/rigid_pairs.h"
#include "collision/problem/collision_problem.h"
#include "scene/validate_scene.h"

namespace gpu_planning_scene::core
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
  ReachabilityFilter reducer_;
  TessellationCache tessellations_;
  RigidPairs fixed_pairs_;
};

/// Options under which no pair is left out of a problem.
CheckerOptions optionsWithAllPairs();

/// What of `scene` is checked for `group` (empty: all): the pairs that the allowed-collision matrix does not allow and,
/// for a group, that have a link which the group moves. Throws Error for an unknown group, two objects of
/// one name, or an object whose shapes or poses are not valid. `report` may be null. Nothing else is left out: see
/// ProblemMaker.
CollisionProblem makeProblem(const PlanningScene& scene, const std::string& group, SceneReport* report);
}  // namespace gpu_planning_scene::core
