#include "benchmark/pairwise_peer.h"

#include <algorithm>
#include <random>
#include <set>

#include "collision/exact/exact_checker.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core::benchmark
{
PairwisePeer::PairwisePeer(std::shared_ptr<const CollisionProblem> problem)
  : problem_(std::move(problem)), self_pairs_(problem_->self_pairs)
{
  if (!problem_->half_spaces.empty())
    throw Error("Bullet and spheres do not support half-spaces; use a scene without half-spaces");
}

bool PairwisePeer::collides(const Eigen::Isometry3d* link_poses)
{
  place(link_poses);
  const std::size_t world = problem_->world.size();
  for (std::size_t i = 0; i < problem_->robot.size(); ++i)
    for (std::size_t k = 0; k < world; ++k)
      if (problem_->world_pairs[i * world + k] != 0 &&
          collidesWithWorld(i, k, problem_->robot[i].padding + problem_->world[k].padding))
        return true;
  return std::any_of(self_pairs_.begin(), self_pairs_.end(),
                     [&](const auto& pair) { return collidesWithSelf(pair[0], pair[1]); });
}

void PairwisePeer::disableDefaultPairs(const RobotModel& robot)
{
  constexpr std::size_t kStates = 2000;
  constexpr std::size_t kAlways = kStates * 95 / 100;
  const ExactChecker exact(problem_, std::make_shared<const Forest>(buildBinnedSah(problem_->tessellations)));
  ExactChecker::Scratch scratch;
  std::set<BodyPair> truly;
  std::vector<std::size_t> collisions(self_pairs_.size());
  std::mt19937_64 generator(1);
  std::vector<double> state(robot.variables().size());
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  for (std::size_t i = 0; i < kStates; ++i)
  {
    robot.randomState(generator, state.data());
    robot.linkPoses(state.data(), poses.data());
    for (const auto& pair : exact.allCollisions(poses.data(), scratch))
      truly.insert(pair);
    place(poses.data());
    for (std::size_t k = 0; k < self_pairs_.size(); ++k)
      collisions[k] += collidesWithSelf(self_pairs_[k][0], self_pairs_[k][1]) ? 1 : 0;
  }
  std::vector<InstancePair> kept;
  for (std::size_t k = 0; k < self_pairs_.size(); ++k)
  {
    const std::int32_t a = problem_->robot[self_pairs_[k][0]].body;
    const std::int32_t b = problem_->robot[self_pairs_[k][1]].body;
    if (collisions[k] < kAlways && truly.count({std::min(a, b), std::max(a, b)}) != 0)
      kept.push_back(self_pairs_[k]);
  }
  self_pairs_ = std::move(kept);
}
}  // namespace gpu_planning_scene::core::benchmark
