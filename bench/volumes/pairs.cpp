#include "volumes/pairs.h"

#include <algorithm>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/binned_sah.h"
#include "collision/exact/cpu_shape_pair.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core::volumes
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;

std::vector<std::uint16_t> depthsOf(const CpuTree& tree)
{
  // Children come after their parents.
  std::vector<std::uint16_t> depths(tree.nodes.size(), 0);
  for (std::size_t i = 0; i < depths.size(); ++i)
    if (tree.nodes[i].count == 0)
      depths[tree.nodes[i].first] = depths[tree.nodes[i].first + 1] = static_cast<std::uint16_t>(depths[i] + 1);
  return depths;
}

struct Instance
{
  std::uint32_t tree;
  Isometry3d pose;
  AlignedBox3d bounds;

  Instance(const CpuForest& forest, std::uint32_t number, const Isometry3d& placed)
    : tree(number), pose(placed), bounds(boundsOf(forest.tree(number), placed))
  {
  }
};

void addPair(std::size_t number, const Instance& a, const Instance& b, std::vector<PlacedPair>& pairs)
{
  if (a.bounds.intersects(b.bounds))
    pairs.push_back({static_cast<std::uint32_t>(number), a.tree, b.tree, a.pose.inverse(Eigen::Isometry) * b.pose});
}
}  // namespace

void PlacedPairs::sortByHits(const std::vector<std::size_t>& hits)
{
  for (std::size_t state = 0; state < states(); ++state)
    std::stable_sort(
        pairs.begin() + static_cast<std::ptrdiff_t>(first[state]),
        pairs.begin() + static_cast<std::ptrdiff_t>(first[state + 1]),
        [&hits](const PlacedPair& a, const PlacedPair& b) { return hits[a.number] > hits[b.number]; });
}

PlacedPairs placePairs(const TestScene& scene, const std::vector<double>& states)
{
  const CollisionProblem problem = ProblemMaker(CheckerOptions{}).make(*scene.scene, "", nullptr);
  if (problem.always_colliding || !problem.half_spaces.empty())
    throw Error(scene.name + ": every state collides or there is a half-space; name another scene");
  PlacedPairs placed;
  placed.forest = CpuForest(problem, buildBinnedSah(problem.tessellations));
  placed.trees = problem.tessellations.size();
  placed.nodes = 0;
  for (std::uint32_t tree = 0; tree < placed.trees; ++tree)
  {
    placed.depths.push_back(depthsOf(placed.forest.tree(tree)));
    placed.nodes += placed.depths.back().size();
  }

  std::vector<Instance> world;
  for (const ShapeInstance& object : problem.world)
    world.emplace_back(placed.forest, object.tree, object.pose);
  const RobotModel& robot = *scene.scene->robot;
  std::vector<Isometry3d> link_poses(robot.links().size());
  std::vector<Instance> links;
  for (std::size_t row = 0; row < states.size(); row += robot.variables().size())
  {
    placed.first.push_back(placed.pairs.size());
    robot.linkPoses(&states[row], link_poses.data());
    links.clear();
    for (const ShapeInstance& instance : problem.robot)
      links.emplace_back(placed.forest, instance.tree, link_poses[instance.link] * instance.pose);
    for (std::size_t pair = 0; pair < problem.world_pairs.size(); ++pair)
      if (problem.world_pairs[pair] != 0)
        addPair(pair, links[pair / world.size()], world[pair % world.size()], placed.pairs);
    for (std::size_t pair = 0; pair < problem.self_pairs.size(); ++pair)
      addPair(problem.world_pairs.size() + pair, links[problem.self_pairs[pair][0]], links[problem.self_pairs[pair][1]],
              placed.pairs);
  }
  placed.first.push_back(placed.pairs.size());
  return placed;
}
}  // namespace gpu_planning_scene::core::volumes
