#include "collision/contacts/body_pairs.h"

#include "collision/exact/exact_checker.h"

// The pairs with the world are not listed, because an octomap has very many instances: they follow from the instances
// of both bodies. Own method.
namespace gpu_planning_scene::core
{
BodyPairs::BodyPairs(const CollisionProblem& problem)
{
  for (const InstancePair& pair : problem.self_pairs)
    self_pairs_[bodiesOf(problem, pair)].push_back(pair);
  for (std::uint32_t i = 0; i < problem.robot.size(); ++i)
    robot_[problem.robot[i].body].push_back(i);
  for (std::uint32_t k = 0; k < problem.world.size(); ++k)
    world_[problem.world[k].body].push_back(k);
}
}  // namespace gpu_planning_scene::core
