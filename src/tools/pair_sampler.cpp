#include "tools/pair_sampler.h"

#include <algorithm>
#include <utility>

#include "base/parallel_for.h"
#include "collision/bounds/problem_maker.h"

namespace gpu_planning_scene::core
{
PairSampler::PairSampler(std::shared_ptr<const RobotModel> robot, const AllowedCollisionMatrix& decided,
                         ForestCache& trees)
  : robot_(std::move(robot))
{
  PlanningScene scene(robot_);
  scene.allowed_collisions = decided;
  problem_ = std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr));
  exact_ = trees.exactCheckerOf(problem_);
}

void PairSampler::add(const std::vector<double>& states, std::size_t count, HitCounts& counts) const
{
  const std::size_t width = robot_->variables().size();
  std::vector<std::vector<BodyPair>> hits(count);
  parallelFor(count, 16,
              [&, scratch = ExactChecker::Scratch(), poses = std::vector<Eigen::Isometry3d>(robot_->links().size())](
                  std::size_t begin, std::size_t end) mutable
              {
                for (std::size_t i = begin; i < end; ++i)
                {
                  robot_->linkPoses(states.data() + i * width, poses.data());
                  hits[i] = exact_->allCollisions(poses.data(), scratch);
                }
              });
  for (const auto& pairs : hits)
    for (const BodyPair& pair : pairs)
      ++counts[{std::min(pair[0], pair[1]), std::max(pair[0], pair[1])}];
}
}  // namespace gpu_planning_scene::core
