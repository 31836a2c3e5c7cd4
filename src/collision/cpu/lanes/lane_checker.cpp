#include "collision/cpu/lanes/lane_checker.h"

#include <algorithm>
#include <utility>

// The kernel proves verdicts for all states of a block at once. Of the pairs that it leaves open, the exact checker
// first tests those that have collided most often for their cost. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMostPairs = 20'000;
}  // namespace

LaneChecker::LaneChecker(std::shared_ptr<const RobotModel> robot, std::shared_ptr<const CollisionProblem> problem,
                         std::shared_ptr<const CpuForest> forest, const ExactChecker& exact)
  : robot_(std::move(robot)),
    problem_(std::move(problem)),
    forest_(std::move(forest)),
    exact_(exact),
    kernel_(lanes::availableKernels().front().kernel)
{
}

bool LaneChecker::suits(const CollisionProblem& problem)
{
  return !problem.always_colliding && instancePairs(problem) <= kMostPairs;
}

ProofStage LaneChecker::requestProofs()
{
  if (!job_)
    job_ = proveInBackground(robot_, problem_, forest_);
  const std::shared_ptr<const RobotProofs> proofs = job_->proofs();
  return !proofs ? ProofStage::None : proofs->has_all_tables ? ProofStage::All : ProofStage::Covers;
}

/// Clears what the scratch has kept for other proofs: with new tables, the pairs have other numbers.
void LaneChecker::useProofs(Scratch& scratch)
{
  if (const std::shared_ptr<const RobotProofs> proofs = job_->proofs(); proofs != proofs_)
  {
    scene_ = std::make_shared<const LaneScene>(*robot_, *problem_, *forest_, proofs);
    proofs_ = proofs;
  }
  if (scratch.scene == scene_)
    return;
  scratch.scene = scene_;
  scratch.buffers.forget();
  scratch.records.assign(scene_->pairCount(), PairRecord{});
}

const float* LaneChecker::kernelMargins(const double* const* margins, std::size_t count, Scratch& scratch) const
{
  if (!margins)
    return nullptr;
  const std::size_t bodies = problem_->robot.size();
  const std::size_t rows = bodies + problem_->self_pairs.size();
  scratch.margins.resize(rows * lanes::kLanes);
  for (std::size_t i = 0; i < rows; ++i)
  {
    const std::size_t place =
        i < bodies ? i : bodies + scratch.scene->selfPairOf(static_cast<std::uint32_t>(i - bodies));
    for (std::size_t lane = 0; lane < lanes::kLanes; ++lane)
      scratch.margins[i * lanes::kLanes + lane] = lanes::kernelMargin(margins[std::min(lane, count - 1)][place]);
  }
  return scratch.margins.data();
}

/// The margin of a pair of the kernel.
double LaneChecker::marginOf(std::uint32_t pair, const double* margins, const LaneScene& scene) const
{
  if (!margins)
    return 0.0;
  const InstancePair& instances = scene.instancesOf(pair);
  const std::size_t bodies = problem_->robot.size();
  return margins[instances[1] < bodies ? bodies + scene.selfPairOf(pair) : instances[0]];
}

std::optional<BodyPair> LaneChecker::decideOpenPairs(const double* state, std::uint32_t* open, std::size_t open_count,
                                                     const double* margins, Scratch& scratch) const
{
  // By collisions found per cost, as in ExactChecker::learnOrder.
  const auto gain = [&](std::uint32_t pair) { return scratch.records[pair].hits / scratch.records[pair].cost; };
  std::sort(open, open + open_count, [&](std::uint32_t a, std::uint32_t b) { return gain(a) > gain(b); });
  scratch.pairs.clear();
  scratch.known.assign(robot_->links().size(), 0);
  for (std::size_t k = 0; k < open_count; ++k)
  {
    const InstancePair& instances = scratch.scene->instancesOf(open[k]);
    scratch.pairs.push_back({instances, marginOf(open[k], margins, *scratch.scene)});
    for (const std::uint32_t instance : instances)
      if (instance < problem_->robot.size())
        robot_->computeLinkPose(state, problem_->robot[instance].link, scratch.poses.data(), scratch.known.data());
  }
  const auto pair = exact_.firstCollisionOf(scratch.pairs.data(), scratch.pairs.size(), scratch.poses.data(),
                                            scratch.exact, scratch.steps);
  for (std::size_t k = 0; k < scratch.steps.size(); ++k)
    scratch.records[open[k]].cost += static_cast<double>(scratch.steps[k]) + 1.0;
  if (pair)
    scratch.records[open[scratch.steps.size() - 1]].hits += 1.0;
  return pair;
}

void LaneChecker::check(const double* states, std::size_t count, std::size_t row, const double* const* margins,
                        Scratch& scratch, BatchResult& result) const
{
  const std::size_t width = robot_->variables().size();
  const LaneScene& scene = *scratch.scene;
  const lanes::Scratch kernel_scratch = scratch.buffers.of(scene);
  scratch.poses.resize(robot_->links().size());
  lanes::Block block;
  scratch.tally.begin(block);
  kernel_(scene.model(), states, static_cast<int>(count), kernelMargins(margins, count, scratch), kernel_scratch,
          block);
  const std::uint64_t begin = block.clock ? block.clock() : 0;
  for (std::size_t lane = 0; lane < count; ++lane)
  {
    const double* const state = states + lane * width;
    const double* const margins_of_state = margins ? margins[lane] : nullptr;
    std::optional<BodyPair> pair;
    if (block.proof[lane] == Proof::Colliding)
      pair = bodiesOf(*problem_, scene.instancesOf(block.pair[lane]));
    else if (block.proof[lane] == Proof::None)
      pair = decideOpenPairs(state, kernel_scratch.open + lane * scene.pairCount(),
                             static_cast<std::size_t>(block.open_count[lane]), margins_of_state, scratch);
    if (pair)
    {
      result.valid[row + lane] = 0;
      result.colliding[row + lane] = *pair;
    }
  }
  scratch.tally.add(block, count, block.clock ? block.clock() - begin : 0);
}
}  // namespace gpu_planning_scene::core
