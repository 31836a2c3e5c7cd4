#include "collision/exact/sampled_collisions.h"

#include <algorithm>
#include <iterator>
#include <random>

// Intersects the sets of colliding pairs of random states. MoveIt's Setup Assistant finds pairs that always collide in
// a similar way.
namespace gpu_planning_scene::core
{
std::vector<BodyPair> collidingInSamples(const RobotModel& robot, const CollisionProblem& problem,
                                         const CpuTraversal& traversal)
{
  std::mt19937_64 generator;  // the same states each time, so that the same scene has the same report
  std::vector<double> state(robot.variables().size());
  const std::vector<double> base = robot.defaultState();
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  CpuTraversal::Scratch scratch;
  std::vector<BodyPair> pairs;
  for (std::size_t i = 0; i < kSampledStates; ++i)
  {
    robot.randomState(generator, base.data(), state.data());
    if (!isValidFor(problem, state.data()))
      return {};
    robot.linkPoses(state.data(), poses.data());
    std::vector<BodyPair> found = traversal.allCollisions(poses.data(), scratch);
    if (problem.always_colliding)
      found.erase(std::remove(found.begin(), found.end(), *problem.always_colliding), found.end());
    std::vector<BodyPair> in_all;
    if (i == 0)
      in_all = std::move(found);
    else
      std::set_intersection(pairs.begin(), pairs.end(), found.begin(), found.end(), std::back_inserter(in_all));
    pairs = std::move(in_all);
    if (pairs.empty())
      break;
  }
  return pairs;
}
}  // namespace gpu_planning_scene::core
