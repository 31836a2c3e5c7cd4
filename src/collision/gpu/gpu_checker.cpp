#include "collision/gpu/gpu_checker.h"

#include <algorithm>
#include <functional>
#include <future>
#include <stdexcept>
#include <utility>

#include "base/parallel_for.h"
#include "collision/cpu/lanes/lane_checker.h"
#include "collision/problem/rows_without.h"
#include "gpu/float_arithmetic.h"
#include "gpu/gl_check.h"
#include "gpu_planning_scene/error.h"
#include "shader_constants.h"

// Runs all GL work on the GL thread of this object. The GPU reports each state as a hit, as free or as undecided.
// Others then decide the undecided states: the cores that work on the batch, or without a batch this object, on all
// cores. Inexact arithmetic with error bounds in front of exact arithmetic is the idea of S. Fortune, C. J. Van Wyk:
// Efficient exact arithmetic for computational geometry. SoCG 1993.
namespace gpu_planning_scene::core
{
namespace
{
/// Whether the shader of the proofs can test all pairs: the loops of an invocation have at most four iterations a pair,
/// and the time to compile it grows with the number of pairs of links.
bool suitsShader(const CollisionProblem& problem)
{
  constexpr std::size_t kIterations = 4;
  constexpr std::size_t kMostSelfPairs = 4000;
  return instancePairs(problem) * kIterations <= INVOCATION_ITERATIONS && problem.self_pairs.size() <= kMostSelfPairs;
}
}  // namespace

GpuChecker::GpuChecker(const BatchCheckerOptions& options, std::shared_ptr<ForestCache> trees)
  : shader_folder_(options.shader_folder.empty() ? shaderFolder() : options.shader_folder),
    gl_(options.device),
    trees_(trees ? std::move(trees) : std::make_shared<ForestCache>())
{
  if (options.max_batch == 0)
    throw Error("max_batch is 0; it must be at least 1");
  try
  {
    gl_.run(
        [&]
        {
          pairs_ = std::make_unique<GpuPairChecker>(shader_folder_, options.traversal, options.max_batch);
          double_fault_ = findEmulatedDouble(shader_folder_);
          if (double_fault_.empty())
            double_fault_ = findDoubleFault(shader_folder_);
        });
  }
  catch (...)
  {
    release();
    throw;
  }
}

GpuChecker::~GpuChecker()
{
  release();
}

void GpuChecker::release()
{
  try
  {
    gl_.run(
        [this]
        {
          kinematics_.reset();
          pairs_.reset();
        });
  }
  catch (const std::exception&)
  {
    // A lost context throws after each job; there is nothing left to release.
  }
}

void GpuChecker::setProblem(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const RobotModel> robot)
{
  try
  {
    gl_.run([&] { apply(*problem, robot); });
  }
  catch (...)
  {
    restore();
    throw;
  }
  usable_ = true;
  problem_ = std::move(problem);
  robot_ = std::move(robot);
  on_cpu_.reset();
}

/// Restores the old problem after a new one did not fit. `apply` writes all buffers again, so it does not matter what a
/// lack of memory has left in them.
void GpuChecker::restore()
{
  usable_ = false;
  if (!problem_)
    return;
  try
  {
    gl_.run([this] { apply(*problem_, robot_); });
    usable_ = true;
  }
  catch (const Error& error)
  {
    throw DeviceLost(std::string("the GPU has lost its scene: ") + error.what());
  }
}

void GpuChecker::apply(const CollisionProblem& problem, const std::shared_ptr<const RobotModel>& robot)
{
  proofs_.reset();
  proofs_fault_.clear();
  pairs_->setProblem(problem);
  // The time to compile the shader grows with the square of the number of links.
  constexpr std::size_t kMaxLinks = 120;
  if (!robot || !double_fault_.empty() || robot->links().size() > kMaxLinks)
  {
    kinematics_.reset();
    kinematics_fault_.clear();
    return;
  }
  if (!kinematics_ || kinematics_->robot() != robot)
  {
    kinematics_ = std::make_unique<GpuKinematics>(shader_folder_, robot);
    kinematics_fault_ = kinematics_->findFault();
  }
  kinematics_->setInstances(problem);
}

std::string GpuChecker::fault() const
{
  for (const std::string& fault : {pairs_->floatFault(), double_fault_, kinematics_fault_, proofs_fault_})
    if (!fault.empty())
      return fault;
  return {};
}

void GpuChecker::selectPairs(std::shared_ptr<const CollisionProblem> problem)
{
  requireUsableScene();
  startOnDevice([&] { pairs_->selectPairs(*problem); }).get();
  proofs_.reset();
  problem_ = std::move(problem);
  on_cpu_.reset();
}

void GpuChecker::useProofs(const std::shared_ptr<const LaneScene>& scene)
{
  if (!scene || scene == proofs_)
    return;
  requireUsableScene();
  proofs_ = scene;
  // The device proves verdicts only if it places the links itself.
  if (!placesLinks() || !LaneChecker::suits(*problem_) || !suitsShader(*problem_))
    return;
  try
  {
    startOnDevice([&] { pairs_->useProofs(*scene, *kinematics_); }).get();
  }
  catch (const DeviceLost&)
  {
    throw;
  }
  catch (const Error& error)
  {
    proofs_fault_ = std::string("proofs on the device: ") + error.what() + "; trees decide all pairs";
  }
}

std::future<void> GpuChecker::startOnDevice(std::function<void()> job)
{
  return gl_.start(
      [this, job = std::move(job)]
      {
        try
        {
          job();
        }
        catch (const OutOfDeviceMemory& error)  // OpenGL is then in an undefined state, through no fault of the caller
        {
          usable_ = false;
          throw DeviceLost(error.what());
        }
      });
}

void GpuChecker::requireUsableScene() const
{
  if (!usable_)
    throw DeviceLost("the GPU failed while its scene was being changed and holds no usable scene");
}

namespace
{
/// The poses of the states of parts, which the CPU computes.
class PosesOfParts : public PoseSource
{
 public:
  PosesOfParts(const CollisionProblem& problem, const RobotModel& robot, PartSource& parts)
    : robot_(robot), parts_(parts), poses_(problem, robot.links().size(), link_poses_)
  {
  }

  void begin(std::size_t begin, std::size_t count) override
  {
    begin_ = begin;
    states_.resize(count * robot_.variables().size());
    copyOnAllCores([this](const StateRange& states, double* to) { parts_.copy(states, to); }, {begin, count},
                   robot_.variables().size(), states_.data());
    poses_.begin(begin, count);
  }
  void place(TexelBuffer& poses) override { poses_.place(poses); }

 private:
  const RobotModel& robot_;
  PartSource& parts_;
  std::size_t begin_ = 0;
  std::vector<double> states_;  // of the part
  const UploadedPoses::LinkPoses link_poses_ = [this](std::size_t row, Eigen::Isometry3d* poses)
  { robot_.linkPoses(&states_[(row - begin_) * robot_.variables().size()], poses); };
  UploadedPoses poses_;
};
}  // namespace

void GpuChecker::check(PartSource& parts, const Margins* margins)
{
  if (placesLinks())
  {
    kinematics_->setStates([&parts](const StateRange& states, double* to) { parts.copy(states, to); });
    return check(*kinematics_, parts, margins);
  }
  PosesOfParts poses(*problem_, *robot_, parts);
  check(poses, parts, margins);
}

void GpuChecker::check(PoseSource& source, PartSource& parts, const Margins* margins)
{
  requireUsableScene();
  startOnDevice([&] { pairs_->check(source, parts, margins); }).get();
}

BodyPair GpuChecker::bodiesOf(std::uint32_t hit) const
{
  const auto [a, b] = GpuPairChecker::pairOf(hit);
  // Ascending order: the body index of an attached object is larger than the index of an object that it hits.
  const std::int32_t first = problem_->robot[a].body;
  const std::int32_t second = bodyOf(*problem_, b);
  return {std::min(first, second), std::max(first, second)};
}

std::vector<std::size_t> GpuChecker::write(const StateRange& states, const std::uint32_t* verdicts,
                                           BatchResult& result) const
{
  /// Returns whether the state is decided.
  const auto write_verdict = [&](std::size_t i)
  {
    if (isHit(verdicts[i]))
    {
      result.valid[states.begin + i] = 0;
      result.colliding[states.begin + i] = bodiesOf(verdicts[i]);
      return true;
    }
    return isFree(verdicts[i]);
  };
  std::vector<std::size_t> undecided = rowsWithout(states.count, write_verdict);
  for (std::size_t& row : undecided)
    row += states.begin;
  return undecided;
}

void GpuChecker::check(const double* states, std::size_t count, BatchResult& result, const Margins* margins)
{
  const std::size_t width = robot_->variables().size();
  const LinkPoses link_poses = [&](std::size_t row, Eigen::Isometry3d* poses)
  { robot_->linkPoses(states + row * width, poses); };
  const std::size_t links = robot_->links().size();
  const PlaceableStates placeable(*robot_);
  if (placesLinks() &&
      rowsWithout(count, [&](std::size_t row) { return placeable.contains(states + row * width); }).empty())
  {
    kinematics_->setStates(states);
    return checkAll(*kinematics_, count, links, link_poses, margins, result);
  }
  UploadedPoses poses(*problem_, links, link_poses);
  checkAll(poses, count, links, link_poses, margins, result);
}

void GpuChecker::checkPoses(std::size_t count, std::size_t link_count, const LinkPoses& link_poses, BatchResult& result)
{
  UploadedPoses poses(*problem_, link_count, link_poses);
  checkAll(poses, count, link_count, link_poses, nullptr, result);
}

namespace
{
/// All states of a result, one part after the other.
class AllStates : public PartSource
{
 public:
  AllStates(const GpuChecker& checker, std::size_t count, BatchResult& result)
    : checker_(checker), count_(count), result_(result)
  {
    result_.valid.assign(count, 1);
    result_.colliding.assign(count, kNoPair);
  }

  StateRange take(std::size_t most) override
  {
    const StateRange next{taken_, std::min(most, count_ - taken_)};
    taken_ = next.end();
    return next;
  }
  void copy(const StateRange& /*states*/, double* /*to*/) override
  {
    throw std::logic_error("the source of the poses has the states");
  }
  void bring(const StateRange& states, const std::uint32_t* verdicts, const GpuWork& /*work*/) override
  {
    brought_ += states.count;
    const std::vector<std::size_t> undecided = checker_.write(states, verdicts, result_);
    undecided_.insert(undecided_.end(), undecided.begin(), undecided.end());
  }

  std::size_t brought() const { return brought_; }
  const std::vector<std::size_t>& undecided() const { return undecided_; }

 private:
  const GpuChecker& checker_;
  const std::size_t count_;
  BatchResult& result_;
  std::size_t taken_ = 0;
  std::size_t brought_ = 0;
  std::vector<std::size_t> undecided_;
};
}  // namespace

void GpuChecker::checkAll(PoseSource& source, std::size_t count, std::size_t link_count, const LinkPoses& link_poses,
                          const Margins* margins, BatchResult& result)
{
  AllStates states(*this, count, result);
  check(source, states, margins);
  if (states.brought() != count)  // the others would stay free
    throw DeviceLost("the device has returned " + std::to_string(states.brought()) + " of " + std::to_string(count) +
                     " states");
  result.undecided_states = states.undecided().size();
  if (!states.undecided().empty())
    settleOnCpu(states.undecided(), link_count, link_poses, margins, result);
}

void GpuChecker::makeTraversal()
{
  if (!on_cpu_)
    on_cpu_ = trees_->exactCheckerOf(problem_);
}

void GpuChecker::settleOnCpu(const std::vector<std::size_t>& rows, std::size_t link_count, const LinkPoses& link_poses,
                             const Margins* margins, BatchResult& result)
{
  makeTraversal();
  parallelFor(rows.size(), 1,
              [&, scratch = ExactChecker::Scratch(), links = std::vector<Eigen::Isometry3d>(link_count)](
                  std::size_t from, std::size_t to) mutable
              {
                for (std::size_t i = from; i < to; ++i)
                {
                  link_poses(rows[i], links.data());
                  const double* const row = margins ? margins->of(rows[i]) : nullptr;
                  if (const auto pair = on_cpu_->firstCollision(links.data(), scratch, row))
                  {
                    result.valid[rows[i]] = 0;
                    result.colliding[rows[i]] = *pair;
                  }
                }
              });
}
}  // namespace gpu_planning_scene::core
