#include "collision/batch_engine.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "collision/state_rows.h"
#include "gpu_planning_scene/error.h"
#include "interface.h"

namespace gpu_planning_scene
{
namespace
{
/// Large enough that threads do not meet often, small enough that they end together.
constexpr std::size_t kStatesPerChunk = 256;

/// Of the second one of a reported pair, see GpuPairChecker::pairOf.
std::int32_t otherBody(const CollisionProblem& problem, std::size_t index)
{
  if (index < problem.robot.size())
    return problem.robot[index].body;
  index -= problem.robot.size();
  return index < problem.world.size() ? problem.world[index].body
                                      : problem.half_spaces[index - problem.world.size()].body;
}
}  // namespace

BatchEngine::BatchEngine(const BatchCheckerOptions& options) : max_batch_(options.max_batch), gl_(options.device)
{
  if (max_batch_ == 0)
    throw Error("max_batch is 0; it must be at least 1");
  const std::string folder = options.shader_folder.empty() ? shaderFolder() : options.shader_folder;
  gl_.run([&] { pairs_ = std::make_unique<GpuPairChecker>(folder, options.traversal, max_batch_); });
}

BatchEngine::~BatchEngine()
{
  gl_.run([this] { pairs_.reset(); });
}

void BatchEngine::setProblem(std::shared_ptr<const CollisionProblem> problem)
{
  try
  {
    gl_.run([&] { pairs_->setProblem(*problem); });
  }
  catch (...)
  {
    if (problem_)
      gl_.run([this] { pairs_->setProblem(*problem_); });
    throw;
  }
  problem_ = std::move(problem);
  on_cpu_.reset();
}

void BatchEngine::selectPairs(std::shared_ptr<const CollisionProblem> problem)
{
  gl_.run([&] { pairs_->selectPairs(*problem); });
  problem_ = std::move(problem);
  on_cpu_.reset();
}

void BatchEngine::check(std::size_t count, std::size_t link_count, const LinkPoses& link_poses, BatchResult& result)
{
  const std::vector<Geometry>& robot = problem_->robot;
  result.valid.assign(count, 1);
  result.colliding.assign(count, {-1, -1});
  std::vector<std::size_t> undecided;
  for (std::size_t begin = 0; begin < count; begin += max_batch_)
  {
    const std::size_t part = std::min(max_batch_, count - begin);
    const std::vector<float> poses = instancePoses(begin, part, link_count, link_poses);
    Verdicts verdicts;
    gl_.run([&] { pairs_->check(poses.data(), part, verdicts); });
    for (std::size_t i = 0; i < part; ++i)
    {
      if (verdicts.flags[i] & STATE_HIT)
      {
        const auto [a, b] = GpuPairChecker::pairOf(verdicts.hits[i]);
        result.valid[begin + i] = 0;
        result.colliding[begin + i] = {robot[a].body, otherBody(*problem_, b)};
      }
      else if (verdicts.flags[i] & STATE_UNDECIDED)
        undecided.push_back(begin + i);
    }
  }
  result.undecided_states = undecided.size();
  const auto start = std::chrono::steady_clock::now();
  if (!undecided.empty())
    settleOnCpu(undecided, link_count, link_poses, result);
  result.undecided_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The poses of all robot instances as GpuPairChecker takes them: kinematics in double, each pose brought near the
/// origin and rounded once.
std::vector<float> BatchEngine::instancePoses(std::size_t begin, std::size_t count, std::size_t link_count,
                                              const LinkPoses& link_poses) const
{
  const std::vector<Geometry>& instances = problem_->robot;
  std::vector<float> poses(count * instances.size() * 12);
  forChunks(count, kStatesPerChunk,
            [&, links = std::vector<Eigen::Isometry3d>(link_count)](std::size_t from, std::size_t to) mutable
            {
              for (std::size_t i = from; i < to; ++i)
              {
                link_poses(begin + i, links.data());
                for (std::size_t k = 0; k < instances.size(); ++k)
                {
                  Eigen::Isometry3d pose = links[static_cast<std::size_t>(instances[k].link)] * instances[k].pose;
                  pose.translation() -= problem_->origin;
                  writePoseRows(pose, &poses[(i * instances.size() + k) * 12]);
                }
              }
            });
  return poses;
}

void BatchEngine::settleOnCpu(const std::vector<std::size_t>& rows, std::size_t link_count, const LinkPoses& link_poses,
                              BatchResult& result)
{
  if (!on_cpu_)
    on_cpu_ = trees_.traversalOf(problem_);
  forChunks(rows.size(), 1,
            [&, scratch = CpuTraversal::Scratch(), links = std::vector<Eigen::Isometry3d>(link_count)](
                std::size_t from, std::size_t to) mutable
            {
              for (std::size_t i = from; i < to; ++i)
              {
                link_poses(rows[i], links.data());
                if (const auto pair = on_cpu_->firstCollision(links.data(), scratch))
                {
                  result.valid[rows[i]] = 0;
                  result.colliding[rows[i]] = *pair;
                }
              }
            });
}
}  // namespace gpu_planning_scene
