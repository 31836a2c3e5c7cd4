#include "collision/checkers/cpu_scene.h"

#include <algorithm>
#include <array>
#include <utility>

#include "collision/exact/sampled_collisions.h"
#include "collision/parallel_for.h"
#include "collision/problem/state_validation.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kStatesPerChunk = 32;

// A large batch is cut into slices, so that its later states profit from proofs that are made in the meantime.
constexpr std::size_t kStatesPerSlice = 16'384;

// Checking this many states takes less time than starting threads. The calling thread also keeps its learned order of
// checks.
constexpr std::size_t kFewStates = 256;

// Loading proofs from disk takes milliseconds of a core. They are loaded after a batch of more states than the first
// number, or after more checked states than the second number.
constexpr std::size_t kBatchBeforeCachedProofs = 64;
constexpr std::size_t kStatesBeforeCachedProofs = 1000;

// The form of a scene that the lane checker needs takes as long to make as the exact checks of a dozen states. It is
// made only when more states than this have been checked in the scene. A scene that changes with every check does not
// pay for it.
constexpr std::size_t kStatesBeforeLanes = 16;
}  // namespace

/// The work space of one check. Its end gives the work space back, also after an exception.
class CpuScene::ScratchLoan
{
 public:
  explicit ScratchLoan(std::mutex& mutex) : mutex_(mutex) {}
  ~ScratchLoan()
  {
    if (!scratch_)
      return;
    const std::lock_guard<std::mutex> lock(mutex_);
    giveBack();
  }
  ScratchLoan(const ScratchLoan&) = delete;
  ScratchLoan& operator=(const ScratchLoan&) = delete;

  /// The caller holds the mutex.
  void take(Group& group, const RobotModel& robot)
  {
    group_ = &group;
    if (group.scratches.empty())
    {
      group.scratches.reserve(++group.scratch_count);  // so that giving it back needs no memory
      scratch_ = std::make_unique<Scratch>(group.decisions);
      scratch_->poses.resize(robot.links().size());
    }
    else
    {
      scratch_ = std::move(group.scratches.back());
      group.scratches.pop_back();
    }
  }

  /// The caller holds the mutex.
  void giveBack() { group_->scratches.push_back(std::move(scratch_)); }

  Scratch& operator*() const { return *scratch_; }

 private:
  std::mutex& mutex_;
  Group* group_ = nullptr;
  std::unique_ptr<Scratch> scratch_;
};

CpuScene::CpuScene(const CheckerOptions& options) : options_(options), maker_(options) {}

void CpuScene::setScene(std::shared_ptr<const PlanningScene> scene)
{
  requireRobot(scene);
  const std::lock_guard<std::mutex> lock(mutex_);
  Group whole;
  whole.problem = std::make_shared<const CollisionProblem>(maker_.make(*scene, "", &whole.report));
  scene_ = std::move(scene);
  groups_.clear();
  groups_.emplace("", std::move(whole));
}

CpuScene::Group& CpuScene::groupOf(const std::string& group)
{
  const auto known = groups_.find(group);
  if (known != groups_.end())
    return known->second;
  Group made;
  made.problem = std::make_shared<const CollisionProblem>(maker_.make(*scene_, group, &made.report));
  return groups_.emplace(group, std::move(made)).first->second;
}

const std::shared_ptr<const CollisionProblem>& CpuScene::problem(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return groupOf(group).problem;
}

/// Samples states here and not in setScene, because most scenes are checked without a report.
SceneReport CpuScene::report(const std::string& name)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  Group& group = groupOf(name);
  if (!group.is_sampled)
  {
    prepare(group);
    std::vector<BodyPair>& pairs = group.report.colliding_in_samples;
    const std::vector<BodyPair> sampled = collidingInSamples(*scene_, *group.problem, *group.within);
    pairs.insert(pairs.end(), sampled.begin(), sampled.end());
    std::sort(pairs.begin(), pairs.end());
    group.is_sampled = true;
  }
  for (const std::unique_ptr<Scratch>& scratch : group.scratches)
  {
    scratch->lanes.tally.flush();
    scratch->near_lanes.tally.flush();
  }
  group.report.decided = group.decisions->report(group.checked);
  return group.report;
}

void CpuScene::prepare(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  prepare(groupOf(group));
}

void CpuScene::prepare(Group& group)
{
  if (group.within)
    return;
  group.within = forest_->traversalOf(group.problem);
  // With a tolerance, the traversal may call states colliding that the proofs call free.
  if (options_.reductions.proofs && options_.tolerance == 0.0 && LaneChecker::suits(*group.problem))
    group.lanes = std::make_unique<LaneChecker>(scene_->robot, group.problem, forest_->forest(), *group.within);
}

void CpuScene::prepareOutside(const std::string& name, Group& group)
{
  if (group.outside)
    return;
  CheckerOptions options = options_;
  options.reductions.reach = false;
  const auto problem = std::make_shared<const CollisionProblem>(ProblemMaker(options).make(*scene_, name, nullptr));
  group.outside = forest_outside_.traversalOf(problem);
}

ProofStage CpuScene::proofStage(Group& group) const
{
  if (!group.lanes)
    return ProofStage::None;
  // If the worker has loaded the proofs, the lane checker's own request makes none.
  const bool are_requested = checked_ > kStatesBeforeProofs || (group.cached_proofs && group.cached_proofs->proofs());
  return are_requested ? group.lanes->requestProofs() : ProofStage::None;
}

ProofStage CpuScene::proofStage(const std::string& name)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  Group& group = groupOf(name);
  // Without proofs in sight, the trees of the CPU are not needed yet.
  if (group.problem->always_colliding || (!group.within && checked_ <= kStatesBeforeProofs))
    return ProofStage::None;
  prepare(group);
  return proofStage(group);
}

std::shared_ptr<const RobotProofs> CpuScene::proofs(const std::string& name)
{
  if (proofStage(name) == ProofStage::None)
    return nullptr;
  const std::lock_guard<std::mutex> lock(mutex_);
  return groupOf(name).lanes->proofs();
}

void CpuScene::countStates(std::size_t count, const std::string& name)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  checked_ += count;
  loadProofs(groupOf(name), count);
}

/// Asks for the proofs on disk after a batch of `count` states, so that the first answer does not wait for them.
void CpuScene::loadProofs(Group& group, std::size_t count) const
{
  if (group.lanes && !group.cached_proofs && checked_ <= kStatesBeforeProofs &&
      (count > kBatchBeforeCachedProofs || checked_ > kStatesBeforeCachedProofs))
    group.cached_proofs = loadProofsInBackground(scene_->robot, group.problem, forest_->forest());
}

void CpuScene::checkRow(const double* state, std::size_t row, const Group& group, const Margins* margins,
                        Scratch& scratch, BatchResult& result) const
{
  if (margins && margins->within[row] == 0)
  {
    result.valid[row] = 0;
    return;
  }
  scene_->robot->linkPoses(state, scratch.poses.data());
  const Eigen::Isometry3d* const poses = scratch.poses.data();
  const auto pair = margins ? group.within->firstCollision(poses, scratch.near, margins->of(row))
                    : isValidFor(*group.problem, state) ? group.within->firstCollision(poses, scratch.within)
                                                        : group.outside->firstCollision(poses, scratch.outside);
  if (pair)
  {
    result.valid[row] = 0;
    result.colliding[row] = *pair;
  }
}

/// Checks states begin to end - 1. `by_lanes`: the proofs of the lane checker are ready.
void CpuScene::checkBlock(const double* states, std::size_t begin, std::size_t end, const Group& group,
                          const Margins* margins, bool by_lanes, Scratch& scratch, BatchResult& result) const
{
  const std::size_t width = scene_->robot->variables().size();
  bool is_taken = by_lanes && end - begin > 1;
  for (std::size_t i = begin; i < end && is_taken; ++i)
    is_taken = (margins ? margins->within[i] != 0 : isValidFor(*group.problem, states + i * width)) &&
               LaneChecker::takes(states + i * width, margins ? scratch.near_lanes : scratch.lanes);
  if (is_taken && margins)
  {
    std::array<const double*, lanes::kLanes> rows;
    for (std::size_t i = begin; i < end; ++i)
      rows[i - begin] = margins->of(i);
    return group.lanes->check(states + begin * width, end - begin, begin, rows.data(), scratch.near_lanes, result);
  }
  if (is_taken)
    return group.lanes->check(states + begin * width, end - begin, begin, nullptr, scratch.lanes, result);
  for (std::size_t i = begin; i < end; ++i)
    checkRow(states + i * width, i, group, margins, scratch, result);
}

Margins CpuScene::margins(const JointNeighbourhood& around, const double* states, std::size_t count,
                          const std::string& name)
{
  validateNeighbourhood(*scene_->robot, around, count);
  const DisplacementBounds* bounds = nullptr;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Group& group = groupOf(name);
    if (!group.displacements)
      group.displacements = std::make_unique<const DisplacementBounds>(scene_->robot, *group.problem, levers_);
    bounds = group.displacements.get();
  }
  return bounds->margins(around, states, count);
}

/// Counts the states of a slice. Returns true if the lane checker takes it; its proofs are then ready in the scratch.
bool CpuScene::countSlice(std::size_t count, Group& group, Scratch& scratch, bool has_margins)
{
  checked_ += count;
  group.checked += count;
  // A single state does not go to the lanes.
  if (count <= 1 || group.checked <= kStatesBeforeLanes || proofStage(group) == ProofStage::None)
    return false;
  group.lanes->useProofs(has_margins ? scratch.near_lanes : scratch.lanes);
  return true;
}

/// Whether the problem is valid for all states.
bool CpuScene::areValid(const double* states, std::size_t count, const CollisionProblem& problem) const
{
  const std::size_t width = scene_->robot->variables().size();
  for (std::size_t i = 0; i < count; ++i)
    if (!isValidFor(problem, states + i * width))
      return false;
  return true;
}

void CpuScene::check(const double* states, std::size_t count, const std::string& name, BatchResult& result,
                     const Margins* margins)
{
  ScratchLoan loan(mutex_);
  Group* used = nullptr;
  bool by_lanes = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Group& group = groupOf(name);
    if (group.problem->always_colliding)
    {
      result.valid.assign(count, 0);
      result.colliding.assign(count, *group.problem->always_colliding);
      return;
    }
    prepare(group);
    loan.take(group, *scene_->robot);
    by_lanes = countSlice(std::min(kStatesPerSlice, count), group, *loan, margins != nullptr);
    used = &group;
  }
  if (!margins && !areValid(states, count, *used->problem))
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    prepareOutside(name, *used);
  }
  result.valid.assign(count, 1);
  result.colliding.assign(count, kNoPair);
  const auto check_range = [&](std::size_t begin, std::size_t end, Scratch& scratch)
  {
    for (std::size_t i = begin; i < end; i += lanes::kLanes)
      checkBlock(states, i, std::min<std::size_t>(i + lanes::kLanes, end), *used, margins, by_lanes, scratch, result);
  };
  for (std::size_t begin = 0; begin < count; begin += kStatesPerSlice)
  {
    const std::size_t size = std::min(kStatesPerSlice, count - begin);
    if (begin != 0)
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      by_lanes = countSlice(size, *used, *loan, margins != nullptr);
    }
    if (size <= kFewStates)
      check_range(begin, begin + size, *loan);
    else
      parallelFor(size, kStatesPerChunk,
                  [&, scratch = *loan](std::size_t first, std::size_t last) mutable
                  { check_range(begin + first, begin + last, scratch); });
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  loadProofs(*used, count);
  loan.giveBack();
}
}  // namespace gpu_planning_scene::core
