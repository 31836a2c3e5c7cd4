#include "benchmark/pairwise_peer.h"

#include <algorithm>
#include <random>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::benchmark
{
PairwisePeer::PairwisePeer(std::shared_ptr<const CollisionProblem> problem)
  : problem_(std::move(problem)), self_pairs_(problem_->self_pairs)
{
  if (!problem_->half_spaces.empty())
    throw Error("Bullet and spheres are not asked about half-spaces; compare with a scene that has none");
}

bool PairwisePeer::collides(const Eigen::Isometry3d* link_poses)
{
  place(link_poses);
  const std::size_t world = problem_->world.size();
  for (std::size_t i = 0; i < problem_->robot.size(); ++i)
    for (std::size_t k = 0; k < world; ++k)
      if (problem_->world_pairs[i * world + k] != 0 &&
          meetsWorld(i, k, problem_->robot[i].padding + problem_->world[k].padding))
        return true;
  return std::any_of(self_pairs_.begin(), self_pairs_.end(),
                     [&](const auto& pair) { return meetsSelf(pair[0], pair[1]); });
}

void PairwisePeer::leaveOutWhatAlwaysCollides(const RobotModel& robot)
{
  constexpr std::size_t kStates = 400;
  constexpr std::size_t kAlways = kStates * 95 / 100;
  std::mt19937_64 generator(1);
  std::vector<double> state(robot.variables().size());
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  std::vector<std::size_t> collisions(self_pairs_.size());
  for (std::size_t i = 0; i < kStates; ++i)
  {
    robot.randomState(generator, state.data());
    robot.linkPoses(state.data(), poses.data());
    place(poses.data());
    for (std::size_t k = 0; k < self_pairs_.size(); ++k)
      collisions[k] += meetsSelf(self_pairs_[k][0], self_pairs_[k][1]) ? 1 : 0;
  }
  std::vector<std::array<std::uint32_t, 2>> kept;
  for (std::size_t k = 0; k < self_pairs_.size(); ++k)
    if (collisions[k] < kAlways)
      kept.push_back(self_pairs_[k]);
  self_pairs_ = std::move(kept);
}
}  // namespace gpu_planning_scene::benchmark
