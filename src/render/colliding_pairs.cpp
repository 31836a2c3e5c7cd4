#include "collision/bounds/problem_maker.h"
#include "collision/exact/exact_checker.h"
#include "collision/exact/forest_cache.h"
#include "collision/problem/collision_problem.h"
#include "render/renderer.h"

namespace gpu_planning_scene::core
{
std::vector<BodyPair> collidingPairs(const PlanningScene& scene, const double* state)
{
  // No pair is left out of the problem, so the state may be outside the joint limits.
  const auto problem = std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr));
  const auto exact = ForestCache().exactCheckerOf(problem);
  std::vector<Eigen::Isometry3d> poses(scene.robot->links().size());
  scene.robot->linkPoses(state, poses.data());
  ExactChecker::Scratch scratch;
  return exact->allCollisions(poses.data(), scratch);
}
}  // namespace gpu_planning_scene::core
