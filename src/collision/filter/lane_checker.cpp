#include "collision/filter/lane_checker.h"

#include <algorithm>
#include <utility>

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMostPairs = 20'000;
}  // namespace

LaneChecker::LaneChecker(std::shared_ptr<const RobotModel> robot, std::shared_ptr<const CollisionProblem> problem,
                         std::shared_ptr<const CpuForest> forest, const CpuTraversal& traversal)
  : robot_(std::move(robot)),
    problem_(std::move(problem)),
    forest_(std::move(forest)),
    traversal_(traversal),
    kernel_(lanes::availableKernels().front().kernel)
{
}

bool LaneChecker::suits(const CollisionProblem& problem)
{
  const std::size_t objects = problem.world.size() + problem.half_spaces.size();
  return !problem.always_colliding && problem.robot.size() * objects + problem.self_pairs.size() <= kMostPairs;
}

bool LaneChecker::isReady()
{
  if (!job_)
    job_ = proveInBackground(robot_, problem_, forest_);
  const std::shared_ptr<const RobotProofs> proofs = job_->proofs();
  if (proofs != proofs_)
  {
    scene_ = std::make_unique<const LaneScene>(robot_, *problem_, *forest_, proofs);
    proofs_ = proofs;
  }
  return scene_ != nullptr;
}

lanes::Scratch LaneChecker::kernelScratch(Scratch& scratch) const
{
  const lanes::Model& model = scene_->model();
  const std::size_t frames = std::size_t{12} * lanes::kLanes * model.frames.count;
  const std::size_t centers = std::size_t{3} * lanes::kLanes * model.bodies.count;
  const std::size_t balls = std::size_t{lanes::kBallNumbers} * model.bodies.count;
  scratch.floats.resize(2 * frames + centers + balls);
  scratch.placed.resize(model.bodies.count);
  scratch.open.resize(lanes::kLanes * scene_->pairCount());
  scratch.trials.resize(std::size_t{lanes::kLevels} * scene_->pairCount(), lanes::Trial{});
  scratch.records.resize(scene_->pairCount());
  scratch.poses.resize(robot_->links().size());
  float* const first = scratch.floats.data();
  return {first,
          first + frames,
          first + 2 * frames,
          first + 2 * frames + centers,
          scratch.placed.data(),
          scratch.open.data(),
          scratch.trials.data()};
}

void LaneChecker::check(const double* states, std::size_t count, std::size_t row, Scratch& scratch,
                        BatchResult& result) const
{
  const std::size_t width = robot_->variables().size();
  const lanes::Scratch kernel_scratch = kernelScratch(scratch);
  const auto decide_exactly = [&](std::size_t lane)
  {
    robot_->linkPoses(states + lane * width, scratch.poses.data());
    if (const auto pair = traversal_.firstCollision(scratch.poses.data(), scratch.exact))
    {
      result.valid[row + lane] = 0;
      result.colliding[row + lane] = *pair;
    }
  };
  bool all_given = true;
  for (std::size_t lane = 0; scene_->hasGivenFrames() && lane < lanes::kLanes; ++lane)
  {
    robot_->linkPoses(states + std::min(lane, count - 1) * width, scratch.poses.data());
    all_given = scene_->fillGiven(scratch.poses.data(), static_cast<int>(lane), kernel_scratch.given) && all_given;
  }
  if (!all_given)
  {
    for (std::size_t lane = 0; lane < count; ++lane)
      decide_exactly(lane);
    return;
  }

  lanes::Block block;
  kernel_(scene_->model(), states, static_cast<int>(count), kernel_scratch, block);
  for (std::size_t lane = 0; lane < count; ++lane)
  {
    const auto collide = [&](const BodyPair& pair)
    {
      result.valid[row + lane] = 0;
      result.colliding[row + lane] = pair;
    };
    if (block.proof[lane] == Proof::Colliding)
    {
      const CpuTraversal::InstancePair& pair = scene_->instancesOf(block.pair[lane]);
      const std::int32_t first = bodyOf(*problem_, pair[0]);
      const std::int32_t second = bodyOf(*problem_, pair[1]);
      collide({std::min(first, second), std::max(first, second)});
    }
    else if (block.proof[lane] == Proof::None)
    {
      std::uint32_t* const open = kernel_scratch.open + lane * scene_->pairCount();
      // By collisions found per cost, as in CpuTraversal::learnOrder.
      const auto gain = [&](std::uint32_t pair) { return scratch.records[pair].hits / scratch.records[pair].cost; };
      std::sort(open, open + block.open_count[lane],
                [&](std::uint32_t a, std::uint32_t b) { return gain(a) > gain(b); });
      scratch.pairs.clear();
      for (int k = 0; k < block.open_count[lane]; ++k)
        scratch.pairs.push_back(scene_->instancesOf(open[k]));
      robot_->linkPoses(states + lane * width, scratch.poses.data());
      const auto pair = traversal_.firstCollisionOf(scratch.pairs.data(), scratch.pairs.size(), scratch.poses.data(),
                                                    scratch.exact, scratch.steps);
      for (std::size_t k = 0; k < scratch.steps.size(); ++k)
        scratch.records[open[k]].cost += static_cast<double>(scratch.steps[k]) + 1.0;
      if (pair)
      {
        scratch.records[open[scratch.steps.size() - 1]].hits += 1.0;
        collide(*pair);
      }
    }
  }
}
}  // namespace gpu_planning_scene::core
