#include "collision/bounds/problem_maker.h"

#include <utility>

// The reductions leave out pairs one after the other: first pairs out of reach, then pairs that no joint moves relative
// to each other. The other pairs become the problem. Own method.
namespace gpu_planning_scene::core
{
namespace
{
std::vector<bool> movedLinks(const RobotModel& robot, const std::string& group)
{
  std::vector<bool> moved(robot.links().size(), group.empty());
  if (!group.empty())
    for (const int link : robot.group(group).moved_links)
      moved[static_cast<std::size_t>(link)] = true;
  return moved;
}
}  // namespace

CollisionProblem ProblemMaker::make(const PlanningScene& scene, const std::string& group, SceneReport* report)
{
  validator_.validate(scene);
  SceneReport counts;
  const std::vector<RobotBody> bodies = robotBodies(scene);
  CheckedPairs pairs = findCheckedPairs(scene, bodies, movedLinks(*scene.robot, group), counts);
  std::vector<VariableRange> ranges;
  if (options_.reductions.reach)
    ranges = reachability_filter_.leaveOutUnreachable(scene, bodies, pairs, counts);
  if (options_.reductions.rigid_pairs)
  {
    const CheckedPairs rigid = RigidPairs::take(*scene.robot, bodies, pairs);
    const std::size_t self = countMoved(rigid.self);
    const std::size_t world = countMoved(rigid.world);
    counts.self_pairs -= self;
    counts.world_pairs -= world;
    counts.rigid_pairs = self + world;
    counts.colliding_in_samples = rigid_pairs_.collisions(scene, bodies, rigid);
    if (!counts.colliding_in_samples.empty())
      counts.always_colliding = counts.colliding_in_samples.front();
  }

  CollisionProblem problem = problemOf(scene, bodies, pairs, options_.reductions.shared_trees, tessellations_);
  problem.direct_primitives = options_.reductions.direct_primitives;
  problem.always_colliding = counts.always_colliding;
  problem.ranges = std::move(ranges);
  counts.trees = problem.tessellations.size();
  counts.shared_trees = problem.robot.size() + problem.world.size() - problem.tessellations.size();
  for (const Tessellation& tree : problem.tessellations)
    counts.triangles += tree.mesh->triangles.size();
  if (report != nullptr)
    *report = counts;
  return problem;
}

CheckerOptions optionsWithAllPairs()
{
  CheckerOptions options;
  options.reductions.reach = false;
  options.reductions.rigid_pairs = false;
  return options;
}

CollisionProblem makeProblem(const PlanningScene& scene, const std::string& group, SceneReport* report)
{
  return ProblemMaker(optionsWithAllPairs()).make(scene, group, report);
}
}  // namespace gpu_planning_scene::core
