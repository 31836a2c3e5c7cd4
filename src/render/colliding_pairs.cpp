#include "collision/collision_problem.h"
#include "collision/cpu_traversal.h"
#include "collision/forest_cache.h"
#include "render/renderer.h"

namespace gpu_planning_scene
{
std::vector<std::array<std::int32_t, 2>> collidingPairs(const PlanningScene& scene, const double* state)
{
  // Nothing is left out, so that the state may lie outside the joints' limits.
  const auto problem = std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr));
  const auto traversal = ForestCache().traversalOf(problem);
  std::vector<Eigen::Isometry3d> poses(scene.robot->links().size());
  scene.robot->linkPoses(state, poses.data());
  CpuTraversal::Scratch scratch;
  return traversal->allCollisions(poses.data(), scratch);
}
}  // namespace gpu_planning_scene
