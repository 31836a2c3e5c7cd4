#pragma once

#include <string>

#include "collision/bounds/reachability_filter.h"
#include "collision/bounds/rigid_pairs.h"
#include "collision/problem/collision_problem.h"
#include "scene/validate_scene.h"

namespace gpu_planning_scene::core
{
/// Makes the collision problems of consecutive scenes, without the pairs that the reductions leave out. Results about a
/// robot and its meshes are kept for the next scene.
class ProblemMaker
{
 public:
  explicit ProblemMaker(const CheckerOptions& options) : options_(options) {}

  /// Like makeProblem, but with the reductions. If Reductions::reach has left pairs out, the problem is valid only for
  /// states within its ranges.
  CollisionProblem make(const PlanningScene& scene, const std::string& group, SceneReport* report);

 private:
  CheckerOptions options_;
  SceneValidator validator_;
  ReachabilityFilter reachability_filter_;
  TessellationCache tessellations_;
  RigidPairs rigid_pairs_;
};

/// Checker options that leave no pair out of a problem.
CheckerOptions optionsWithAllPairs();

/// The collision problem of `scene` for `group` (empty: all joints). It contains each pair that the allowed collision
/// matrix does not allow; for a group, the group must move a link of the pair. No further pair is left out, see
/// ProblemMaker. `report` may be null. Throws Error for an unknown group, for two objects with the same name, and for
/// an object with invalid shapes or poses.
CollisionProblem makeProblem(const PlanningScene& scene, const std::string& group, SceneReport* report);
}  // namespace gpu_planning_scene::core
