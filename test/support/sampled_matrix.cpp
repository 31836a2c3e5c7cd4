#include "support/sampled_matrix.h"

#include <map>

#include "collision/cpu_traversal.h"

namespace gpu_planning_scene
{
void allowSampledPairs(const std::vector<double>& states, PlanningScene& scene)
{
  const RobotModel& robot = *scene.robot;
  const auto& links = robot.links();
  for (const auto& [first, second] : robot.adjacentLinks())
  {
    scene.allowed_collisions.setEntry(links[first].name, links[second].name, true);
  }
  PlanningScene alone = scene;
  alone.objects.clear();
  const auto problem = std::make_shared<const CollisionProblem>(makeProblem(alone, "", nullptr));
  const auto forest = std::make_shared<const Forest>(buildBinnedSah(problem->trees));
  const CpuTraversal traversal(problem, forest);

  const std::size_t count = states.size() / robot.variables().size();
  std::vector<Eigen::Isometry3d> poses(links.size());
  CpuTraversal::Scratch scratch;
  std::map<CpuTraversal::BodyPair, std::size_t> collisions;
  for (const auto& pair : problem->self_pairs)
  {
    collisions[{problem->robot[pair[0]].body, problem->robot[pair[1]].body}] = 0;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    robot.linkPoses(states.data() + i * robot.variables().size(), poses.data());
    for (const auto& pair : traversal.allCollisions(poses.data(), scratch))
    {
      ++collisions[pair];
    }
  }
  for (const auto& [pair, times] : collisions)
  {
    if (times == 0 || times == count)
    {
      scene.allowed_collisions.setEntry(links[pair[0]].name, links[pair[1]].name, true);
    }
  }
}
}  // namespace gpu_planning_scene
