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
  constexpr int kStates = 200;
  std::mt19937_64 generator(1);
  std::vector<double> state(robot.variables().size());
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  std::vector<std::array<std::uint32_t, 2>> always = self_pairs_;
  for (int i = 0; i < kStates && !always.empty(); ++i)
  {
    robot.randomState(generator, state.data());
    robot.linkPoses(state.data(), poses.data());
    place(poses.data());
    always.erase(
        std::remove_if(always.begin(), always.end(), [&](const auto& pair) { return !meetsSelf(pair[0], pair[1]); }),
        always.end());
  }
  self_pairs_.erase(
      std::remove_if(self_pairs_.begin(), self_pairs_.end(),
                     [&](const auto& pair) { return std::find(always.begin(), always.end(), pair) != always.end(); }),
      self_pairs_.end());
}
}  // namespace gpu_planning_scene::benchmark
