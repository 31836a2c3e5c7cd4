#include "collision/cpu/cpu_scene.h"

#include <algorithm>
#include <array>
#include <utility>

#include "collision/exact/sampled_collisions.h"
#include "collision/problem/state_validation.h"

namespace gpu_planning_scene::core
{
namespace
{
// Loading proofs from disk takes milliseconds of a core. They are loaded after a batch of more states than the first
// number, or after more checked states than the second number.
constexpr std::size_t kBatchBeforeCachedProofs = 64;
constexpr std::size_t kStatesBeforeCachedProofs = 1000;

// The form of a scene that the lane checker needs takes as long to make as the exact checks of a dozen states. It is
// made only when more states than this have been checked in the scene. A scene that changes with every check does not
// pay for it.
constexpr std::size_t kStatesBeforeLanes = 16;
}  // namespace

CpuScene::CpuScene(const CheckerOptions& options) : options_(options), maker_(options) {}

void CpuScene::setScene(std::shared_ptr<const PlanningScene> scene, bool is_prepared)
{
  requireRobot(scene);
  const std::lock_guard<std::mutex> lock(mutex_);
  std::map<std::string, Group> groups;
  Group& whole = groups[""];
  whole.problem = std::make_shared<const CollisionProblem>(maker_.make(*scene, "", &whole.report));
  if (is_prepared)
    prepare(whole, scene->robot);
  scene_ = std::move(scene);
  groups_.swap(groups);
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
    prepare(group, scene_->robot);
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
  prepare(groupOf(group), scene_->robot);
}

void CpuScene::prepare(Group& group, const std::shared_ptr<const RobotModel>& robot)
{
  if (group.within)
    return;
  group.within = forest_->exactCheckerOf(group.problem);
  if (options_.reductions.proofs && LaneChecker::suits(*group.problem))
    group.lanes = std::make_unique<LaneChecker>(robot, group.problem, forest_->forest(), *group.within);
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
  prepare(group, scene_->robot);
  return proofStage(group);
}

std::shared_ptr<const LaneScene> CpuScene::deviceProofs(const std::string& name)
{
  if (proofStage(name) == ProofStage::None)
    return nullptr;
  const std::lock_guard<std::mutex> lock(mutex_);
  Group& group = groupOf(name);
  if (const std::shared_ptr<const RobotProofs> proofs = group.lanes->proofs(); proofs != group.device_proofs)
  {
    group.device_scene = std::make_shared<const LaneScene>(*scene_->robot, *group.problem, *forest_->forest(), proofs,
                                                           lanes::kDeviceRounding);
    group.device_proofs = proofs;
  }
  return group.device_scene;
}

void CpuScene::countBatch(std::size_t count, std::size_t by_devices, const std::string& name)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  checked_ += by_devices;
  loadProofs(groupOf(name), count);
}

/// Asks for the proofs on disk after a batch of `count` states, so that the first answer does not wait for them.
void CpuScene::loadProofs(Group& group, std::size_t count) const
{
  if (group.lanes && !group.cached_proofs && checked_ <= kStatesBeforeProofs &&
      (count > kBatchBeforeCachedProofs || checked_ > kStatesBeforeCachedProofs))
    group.cached_proofs = loadProofsInBackground(scene_->robot, group.problem, forest_->forest());
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

void CpuScene::countStates(std::size_t count, Group& group)
{
  checked_ += count;
  group.checked += count;
}

/// Makes the newest proofs ready in the scratch. Returns false if the lane checker is not to be used.
bool CpuScene::prepareLanes(Group& group, Scratch& scratch, bool has_margins)
{
  if (group.checked <= kStatesBeforeLanes || proofStage(group) == ProofStage::None)
    return false;
  group.lanes->useProofs(has_margins ? scratch.near_lanes : scratch.lanes);
  return true;
}

CpuScene::Core::Core(CpuScene& scene, const std::string& group) : scene_(scene), name_(group)
{
  const std::lock_guard<std::mutex> lock(scene_.mutex_);
  group_ = &scene_.groupOf(group);
  if (group_->problem->always_colliding)
    return;
  scene_.prepare(*group_, scene_.scene_->robot);
  if (group_->scratches.empty())
  {
    group_->scratches.reserve(++group_->scratch_count);  // so that giving it back needs no memory
    scratch_ = std::make_unique<Scratch>(group_->decisions);
    scratch_->poses.resize(scene_.scene_->robot->links().size());
  }
  else
  {
    scratch_ = std::move(group_->scratches.back());
    group_->scratches.pop_back();
  }
}

CpuScene::Core::~Core()
{
  if (!scratch_)
    return;
  const std::lock_guard<std::mutex> lock(scene_.mutex_);
  giveBack();
}

void CpuScene::Core::endBatch(std::size_t count)
{
  if (!scratch_)
    return;
  const std::lock_guard<std::mutex> lock(scene_.mutex_);
  giveBack();
  scene_.loadProofs(*group_, count);
}

/// The caller holds the mutex of the scene.
void CpuScene::Core::giveBack()
{
  scene_.countStates(uncounted_, *group_);
  group_->scratches.push_back(std::move(scratch_));
}

std::size_t CpuScene::Core::check(const double* states, const std::vector<StateRange>& part, const Margins* margins,
                                  BatchResult& result)
{
  std::size_t count = 0;
  for (const StateRange& range : part)
    count += range.count;
  if (count == 0)
    return 0;
  if (const auto& colliding = group_->problem->always_colliding)
  {
    for (const StateRange& range : part)
    {
      std::fill_n(&result.valid[range.begin], range.count, 0);
      std::fill_n(&result.colliding[range.begin], range.count, *colliding);
    }
    return count;
  }
  uncounted_ += count;
  bool by_lanes = false;
  if (count > 1)  // a single state does not go to the lanes
  {
    const std::lock_guard<std::mutex> lock(scene_.mutex_);
    scene_.countStates(std::exchange(uncounted_, 0), *group_);
    by_lanes = scene_.prepareLanes(*group_, *scratch_, margins != nullptr);
  }
  for (const StateRange& range : part)
    for (std::size_t i = range.begin; i < range.end(); i += lanes::kLanes)
      checkBlock(states, i, std::min<std::size_t>(i + lanes::kLanes, range.end()), margins, by_lanes, result);
  return count;
}

/// Checks states begin to end - 1. `by_lanes`: the proofs of the lane checker are ready.
void CpuScene::Core::checkBlock(const double* states, std::size_t begin, std::size_t end, const Margins* margins,
                                bool by_lanes, BatchResult& result)
{
  const std::size_t width = scene_.scene_->robot->variables().size();
  LaneChecker::Scratch& lane_scratch = margins ? scratch_->near_lanes : scratch_->lanes;
  bool is_taken = by_lanes && end - begin > 1;
  for (std::size_t i = begin; i < end && is_taken; ++i)
    is_taken = (margins ? margins->within[i] != 0 : isValidFor(*group_->problem, states + i * width)) &&
               LaneChecker::takes(states + i * width, lane_scratch);
  if (!is_taken)
  {
    for (std::size_t i = begin; i < end; ++i)
      checkRow(states + i * width, i, margins, result);
    return;
  }
  std::array<const double*, lanes::kLanes> rows;
  for (std::size_t i = begin; i < end && margins; ++i)
    rows[i - begin] = margins->of(i);
  group_->lanes->check(states + begin * width, end - begin, begin, margins ? rows.data() : nullptr, lane_scratch,
                       result);
}

void CpuScene::Core::checkRow(const double* state, std::size_t row, const Margins* margins, BatchResult& result)
{
  if (margins && margins->within[row] == 0)
  {
    result.valid[row] = 0;
    return;
  }
  scene_.scene_->robot->linkPoses(state, scratch_->poses.data());
  const Eigen::Isometry3d* const poses = scratch_->poses.data();
  const auto pair = margins ? group_->within->firstCollision(poses, scratch_->near, margins->of(row))
                    : isValidFor(*group_->problem, state) ? group_->within->firstCollision(poses, scratch_->within)
                                                          : outside().firstCollision(poses, scratch_->outside);
  if (pair)
  {
    result.valid[row] = 0;
    result.colliding[row] = *pair;
  }
}

/// The traversal of all pairs, for states for which the problem is not valid.
const ExactChecker& CpuScene::Core::outside()
{
  if (outside_)
    return *outside_;
  const std::lock_guard<std::mutex> lock(scene_.mutex_);
  if (!group_->outside)
  {
    CheckerOptions options = scene_.options_;
    options.reductions.reach = false;
    const auto problem =
        std::make_shared<const CollisionProblem>(ProblemMaker(options).make(*scene_.scene_, name_, nullptr));
    group_->outside = scene_.forest_outside_.exactCheckerOf(problem);
  }
  outside_ = group_->outside.get();
  return *outside_;
}
}  // namespace gpu_planning_scene::core
