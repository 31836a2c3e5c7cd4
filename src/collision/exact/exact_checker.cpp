#include "collision/exact/exact_checker.h"

#include <algorithm>
#include <numeric>
#include <utility>

// Per robot instance, a tree over the world's objects is the broad phase; CpuShapePair decides the pairs that remain.
// Checks are sorted by their past success per cost, so that most colliding states need few checks. This order has the
// least expected cost for independent checks (H. A. Simon, J. B. Kadane: Optimal problem-solving search: All-or-none
// solutions. Artificial Intelligence 6(3), 1975).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;

constexpr std::uint64_t kStatesPerOrder = 512;

AlignedBox3d grown(const AlignedBox3d& box, double margin)
{
  return {box.min().array() - margin, box.max().array() + margin};
}

}  // namespace

std::int32_t bodyOf(const CollisionProblem& problem, std::size_t instance)
{
  if (instance < problem.robot.size())
    return problem.robot[instance].body;
  instance -= problem.robot.size();
  return instance < problem.world.size() ? problem.world[instance].body
                                         : problem.half_spaces[instance - problem.world.size()].body;
}

BodyPair bodiesOf(const CollisionProblem& problem, const InstancePair& pair)
{
  const std::int32_t first = bodyOf(problem, pair[0]);
  const std::int32_t second = bodyOf(problem, pair[1]);
  return {std::min(first, second), std::max(first, second)};
}

std::vector<AlignedBox3d> worldBounds(const CollisionProblem& problem, const CpuForest& forest)
{
  std::vector<AlignedBox3d> bounds;
  bounds.reserve(problem.world.size());
  for (const ShapeInstance& object : problem.world)
    bounds.push_back(grown(boundsOf(forest.tree(object.tree), object.pose), object.padding));
  return bounds;
}

ExactChecker::ExactChecker(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const Forest> forest)
  : ExactChecker(problem, std::make_shared<const CpuForest>(*problem, *forest))
{
}

ExactChecker::ExactChecker(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const CpuForest> forest,
                           std::shared_ptr<const ObjectTree> objects)
  : problem_(std::move(problem)),
    forest_(std::move(forest)),
    pair_(forest_),
    objects_(objects ? std::move(objects)
                     : std::make_shared<const ObjectTree>(worldBounds(*problem_, *forest_), ObjectTree()))
{
}

void ExactChecker::findNearObjects(const AlignedBox3d& bounds, Scratch& scratch) const
{
  scratch.near_objects.clear();
  objects_->visitOverlapping(bounds, scratch.pair.nodes,
                             [&scratch](std::uint32_t object)
                             {
                               scratch.near_objects.push_back(object);
                               return false;
                             });
}

void ExactChecker::startState(Scratch& scratch) const
{
  const std::size_t checks = problem_->robot.size() + problem_->self_pairs.size();
  if (scratch.order.size() != checks)
  {
    scratch.order.resize(checks);
    std::iota(scratch.order.begin(), scratch.order.end(), 0u);
    scratch.hits.assign(checks, 0.0);
    scratch.cost.assign(checks, 1.0);
    scratch.states = 0;
  }
  scratch.poses.resize(problem_->robot.size());
  scratch.bounds.resize(problem_->robot.size());
  scratch.placed.assign(problem_->robot.size(), 0);
}

void ExactChecker::place(std::uint32_t instance, const Isometry3d* link_poses, Scratch& scratch) const
{
  if (scratch.placed[instance] == 0)
  {
    const ShapeInstance& shape = problem_->robot[instance];
    scratch.poses[instance] = placed(shape, link_poses);
    scratch.bounds[instance] = boundsOf(forest_->tree(shape.tree), scratch.poses[instance]);
    scratch.placed[instance] = 1;
  }
}

bool ExactChecker::collides(const InstancePair& pair, double margin, Scratch& scratch) const
{
  const auto& robot = problem_->robot;
  const std::uint32_t tree = robot[pair[0]].tree;
  const Isometry3d& pose = scratch.poses[pair[0]];
  const double required = requiredDistance(*problem_, pair) + margin;
  if (pair[1] < robot.size())
    return pair_.collide(tree, pose, robot[pair[1]].tree, scratch.poses[pair[1]], required, scratch.pair);
  const std::size_t object = pair[1] - robot.size();
  if (object < problem_->world.size())
  {
    const ShapeInstance& other = problem_->world[object];
    return pair_.collide(tree, pose, other.tree, other.pose, required, scratch.pair);
  }
  const WorldHalfSpace& other = problem_->half_spaces[object - problem_->world.size()];
  return pair_.collide(tree, pose, {other.normal, other.offset}, required, scratch.pair);
}

template <class Visit>
bool ExactChecker::checkWorld(std::uint32_t instance, double margin, Scratch& scratch, const Visit& visit) const
{
  const auto& half_spaces = problem_->half_spaces;
  const auto robots = static_cast<std::uint32_t>(problem_->robot.size());
  const auto objects = static_cast<std::uint32_t>(problem_->world.size());
  findNearObjects(grown(scratch.bounds[instance], problem_->robot[instance].padding + margin), scratch);
  for (const std::uint32_t object : scratch.near_objects)
    if (const InstancePair pair = {instance, robots + object};
        problem_->world_pairs[instance * problem_->world.size() + object] != 0 && collides(pair, margin, scratch) &&
        visit(pair))
      return true;
  for (std::uint32_t k = 0; k < half_spaces.size(); ++k)
    if (const InstancePair pair = {instance, robots + objects + k};
        problem_->half_space_pairs[instance * half_spaces.size() + k] != 0 && collides(pair, margin, scratch) &&
        visit(pair))
      return true;
  return false;
}

template <class Visit>
bool ExactChecker::check(std::uint32_t number, const Isometry3d* link_poses, double margin, Scratch& scratch,
                         const Visit& visit) const
{
  const auto& robot = problem_->robot;
  if (number < robot.size())
  {
    place(number, link_poses, scratch);
    return checkWorld(number, margin, scratch, visit);
  }
  const InstancePair& pair = problem_->self_pairs[number - robot.size()];
  place(pair[0], link_poses, scratch);
  place(pair[1], link_poses, scratch);
  return grown(scratch.bounds[pair[0]], margin).intersects(scratch.bounds[pair[1]]) &&
         collides(pair, margin, scratch) && visit(pair);
}

/// Sorts the checks by collisions found per cost, which makes the expected cost of finding a collision small. Sorts
/// after 1, 2, 4, ... states, then every kStatesPerOrder states.
void ExactChecker::learnOrder(Scratch& scratch)
{
  const std::uint64_t states = ++scratch.states;
  if (states % kStatesPerOrder != 0 && (states > kStatesPerOrder || (states & (states - 1)) != 0))
    return;
  std::sort(scratch.order.begin(), scratch.order.end(),
            [&scratch](std::uint32_t a, std::uint32_t b)
            {
              const double gain_a = scratch.hits[a] / scratch.cost[a];
              const double gain_b = scratch.hits[b] / scratch.cost[b];
              return gain_a != gain_b ? gain_a > gain_b : a < b;
            });
}

std::optional<BodyPair> ExactChecker::firstCollision(const Isometry3d* link_poses, Scratch& scratch,
                                                     const double* margins) const
{
  std::optional<BodyPair> found = problem_->always_colliding;
  if (found)
    return found;
  startState(scratch);
  for (std::size_t k = 0; k < scratch.order.size(); ++k)
  {
    const std::uint32_t number = scratch.order[k];
    const auto visit = [this, &found](const InstancePair& pair)
    {
      found = bodiesOf(*problem_, pair);
      return true;
    };
    const std::uint64_t before = scratch.pair.steps;
    const bool hit = check(number, link_poses, margins ? margins[number] : 0.0, scratch, visit);
    scratch.cost[number] += static_cast<double>(scratch.pair.steps - before) + 1.0;
    scratch.hits[number] += hit ? 1.0 : 0.0;
    if (hit)
      break;
  }
  learnOrder(scratch);
  return found;
}

std::optional<BodyPair> ExactChecker::firstCollisionOf(const OpenPair* pairs, std::size_t count,
                                                       const Isometry3d* link_poses, Scratch& scratch,
                                                       std::vector<std::uint64_t>& steps) const
{
  const auto& robot = problem_->robot;
  scratch.poses.resize(robot.size());
  steps.clear();
  for (std::size_t i = 0; i < count; ++i)
  {
    for (const std::uint32_t instance : pairs[i].instances)
      if (instance < robot.size())
        scratch.poses[instance] = placed(robot[instance], link_poses);
    const std::uint64_t before = scratch.pair.steps;
    const bool collide = collides(pairs[i].instances, pairs[i].margin, scratch);
    steps.push_back(scratch.pair.steps - before);
    if (collide)
      return bodiesOf(*problem_, pairs[i].instances);
  }
  return std::nullopt;
}

std::vector<BodyPair> ExactChecker::allCollisions(const Isometry3d* link_poses, Scratch& scratch) const
{
  std::vector<BodyPair> found;
  if (problem_->always_colliding)
    found.push_back(*problem_->always_colliding);
  startState(scratch);
  for (const std::uint32_t number : scratch.order)
  {
    const auto visit = [this, &found](const InstancePair& pair)
    {
      found.push_back(bodiesOf(*problem_, pair));
      return false;
    };
    check(number, link_poses, 0.0, scratch, visit);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<InstancePair> ExactChecker::collidingInstances(const Isometry3d* link_poses, Scratch& scratch) const
{
  std::vector<InstancePair> found;
  startState(scratch);
  for (const std::uint32_t number : scratch.order)
  {
    const auto visit = [&found](const InstancePair& pair)
    {
      found.push_back(pair);
      return false;
    };
    check(number, link_poses, 0.0, scratch, visit);
  }
  std::sort(found.begin(), found.end());
  return found;
}
}  // namespace gpu_planning_scene::core
