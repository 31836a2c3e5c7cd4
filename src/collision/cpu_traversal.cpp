#include "cpu_traversal.h"

#include <algorithm>
#include <utility>

namespace gpu_planning_scene
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::uint32_t kWorldLeafSize = 2;

AlignedBox3d grown(const AlignedBox3d& box, double margin)
{
  return {box.min().array() - margin, box.max().array() + margin};
}

CpuTraversal::BodyPair bodyPair(std::int32_t a, std::int32_t b)
{
  return {std::min(a, b), std::max(a, b)};
}
}  // namespace

CpuTraversal::CpuTraversal(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const Forest> forest)
  : CpuTraversal(problem, std::make_shared<const CpuForest>(*problem, std::move(forest)))
{
}

CpuTraversal::CpuTraversal(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const CpuForest> forest)
  : problem_(std::move(problem)), pair_(std::move(forest), problem_->tolerance)
{
  for (const Geometry& object : problem_->world)
  {
    world_bounds_.push_back(grown(pair_.boundsOf(object.tree, object.pose), object.padding));
  }
  world_tree_ = buildBinnedSah(world_bounds_, kWorldLeafSize);
}

void CpuTraversal::findNearObjects(const AlignedBox3d& bounds, Scratch& scratch) const
{
  scratch.near_objects.clear();
  if (world_tree_.nodes.empty())
  {
    return;
  }
  const Vector3d center = bounds.center();
  const Vector3d half = 0.5 * bounds.sizes();
  std::vector<std::uint32_t>& stack = scratch.pair.nodes;
  stack.assign(1, 0u);
  while (!stack.empty())
  {
    const Node& node = world_tree_.nodes[stack.back()];
    stack.pop_back();
    if (((centerOf(node) - center).cwiseAbs().array() > (halfOf(node) + half).array()).any())
    {
      continue;
    }
    if (node.count == 0)
    {
      stack.push_back(node.first);
      stack.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
      const std::uint32_t object = world_tree_.order[i];
      if (world_bounds_[object].intersects(bounds))
      {
        scratch.near_objects.push_back(object);
      }
    }
  }
}

template <class Visit>
void CpuTraversal::visitCollisions(const Isometry3d* link_poses, Scratch& scratch, const Visit& visit) const
{
  if (problem_->always_colliding && visit(*problem_->always_colliding))
  {
    return;
  }
  const auto& robot = problem_->robot;
  const auto& half_spaces = problem_->half_spaces;
  scratch.poses.resize(robot.size());
  scratch.bounds.resize(robot.size());
  for (std::size_t i = 0; i < robot.size(); ++i)
  {
    scratch.poses[i] = link_poses[robot[i].link] * robot[i].pose;
    scratch.bounds[i] = pair_.boundsOf(robot[i].tree, scratch.poses[i]);
  }
  for (std::size_t i = 0; i < robot.size(); ++i)
  {
    findNearObjects(grown(scratch.bounds[i], robot[i].padding), scratch);
    for (const std::uint32_t object : scratch.near_objects)
    {
      const Geometry& other = problem_->world[object];
      if (problem_->world_pairs[i * problem_->world.size() + object] != 0 &&
          pair_.collide(robot[i].tree, scratch.poses[i], other.tree, other.pose, robot[i].padding + other.padding,
                        scratch.pair) &&
          visit(bodyPair(robot[i].body, other.body)))
      {
        return;
      }
    }
    for (std::size_t k = 0; k < half_spaces.size(); ++k)
    {
      const WorldHalfSpace& other = half_spaces[k];
      if (problem_->half_space_pairs[i * half_spaces.size() + k] != 0 &&
          pair_.collide(robot[i].tree, scratch.poses[i], {other.normal, other.offset}, robot[i].padding + other.padding,
                        scratch.pair) &&
          visit(bodyPair(robot[i].body, other.body)))
      {
        return;
      }
    }
  }
  for (const auto& [first, second] : problem_->self_pairs)
  {
    if (scratch.bounds[first].intersects(scratch.bounds[second]) &&
        pair_.collide(robot[first].tree, scratch.poses[first], robot[second].tree, scratch.poses[second], 0.0,
                      scratch.pair) &&
        visit(bodyPair(robot[first].body, robot[second].body)))
    {
      return;
    }
  }
}

std::optional<CpuTraversal::BodyPair> CpuTraversal::firstCollision(const Isometry3d* link_poses, Scratch& scratch) const
{
  std::optional<BodyPair> found;
  visitCollisions(link_poses, scratch,
                  [&found](const BodyPair& pair)
                  {
                    found = pair;
                    return true;
                  });
  return found;
}

std::vector<CpuTraversal::BodyPair> CpuTraversal::allCollisions(const Isometry3d* link_poses, Scratch& scratch) const
{
  std::vector<BodyPair> found;
  visitCollisions(link_poses, scratch,
                  [&found](const BodyPair& pair)
                  {
                    found.push_back(pair);
                    return false;
                  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}
}  // namespace gpu_planning_scene
