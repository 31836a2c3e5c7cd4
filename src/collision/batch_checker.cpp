#include "gpu_planning_scene/batch_checker.h"

#include <chrono>
#include <map>
#include <mutex>
#include <utility>

#include "collision/cpu_traversal.h"
#include "collision/gpu_pair_checker.h"
#include "collision/state_rows.h"
#include "gpu/gl_thread.h"
#include "gpu_planning_scene/error.h"
#include "interface.h"

namespace gpu_planning_scene
{
namespace
{
constexpr std::size_t kStatesPerChunk = 256;

struct GroupProblem
{
  SceneReport report;
  std::shared_ptr<const CollisionProblem> problem;
  std::unique_ptr<const CpuTraversal> exact;  // made when a state is undecided for the first time
};
}  // namespace

struct BatchChecker::Impl
{
  std::mutex mutex;
  std::size_t max_batch = 0;
  std::unique_ptr<GlThread> gl;
  std::unique_ptr<GpuPairChecker> pairs;  // lives on the GL thread

  std::shared_ptr<const PlanningScene> scene;
  std::map<std::string, GroupProblem> groups;
  std::string selected_group;             // whose pairs the GPU has now
  std::shared_ptr<const Forest> forest;   // read back when a state is undecided for the first time

  GroupProblem& groupProblem(const std::string& group);
  std::vector<float> instancePoses(const double* states, std::size_t count) const;
  void settleOnCpu(GroupProblem& group, const double* states, const std::vector<std::size_t>& rows, BatchResult& result);
};

GroupProblem& BatchChecker::Impl::groupProblem(const std::string& group)
{
  const auto known = groups.find(group);
  if (known != groups.end())
    return known->second;
  GroupProblem made;
  made.problem = std::make_shared<const CollisionProblem>(makeProblem(*scene, group, &made.report));
  return groups.emplace(group, std::move(made)).first->second;
}

/// The poses of all robot instances in `count` states, as GpuPairChecker takes them. Kinematics are in double; each pose is
/// rounded once.
std::vector<float> BatchChecker::Impl::instancePoses(const double* states, std::size_t count) const
{
  const RobotModel& robot = *scene->robot;
  const std::vector<Geometry>& instances = groups.at("").problem->robot;
  std::vector<float> poses(count * instances.size() * 12);
  forChunks(count, kStatesPerChunk,
            [&, links = std::vector<Eigen::Isometry3d>(robot.links().size())](std::size_t begin, std::size_t end) mutable
            {
              for (std::size_t i = begin; i < end; ++i)
              {
                robot.linkPoses(states + i * robot.variables().size(), links.data());
                for (std::size_t k = 0; k < instances.size(); ++k)
                  writePoseRows(links[static_cast<std::size_t>(instances[k].body)] * instances[k].pose,
                                &poses[(i * instances.size() + k) * 12]);
              }
            });
  return poses;
}

void BatchChecker::Impl::settleOnCpu(GroupProblem& group, const double* states, const std::vector<std::size_t>& rows,
                                     BatchResult& result)
{
  if (!forest)
    gl->run([this] { forest = std::make_shared<const Forest>(pairs->scene().readForest()); });
  if (!group.exact)
    group.exact = std::make_unique<const CpuTraversal>(group.problem, forest);
  const RobotModel& robot = *scene->robot;
  forChunks(rows.size(), 1,
            [&, scratch = CpuTraversal::Scratch(), poses = std::vector<Eigen::Isometry3d>(robot.links().size())](
                std::size_t begin, std::size_t end) mutable
            {
              for (std::size_t i = begin; i < end; ++i)
              {
                robot.linkPoses(states + rows[i] * robot.variables().size(), poses.data());
                const auto pair = group.exact->firstCollision(poses.data(), scratch);
                result.valid[rows[i]] = pair ? 0 : 1;
                if (pair)
                  result.colliding[rows[i]] = *pair;
              }
            });
}

BatchChecker::BatchChecker(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options)
  : impl_(std::make_unique<Impl>())
{
  if (options.max_batch == 0)
    throw Error("max_batch is 0; it must be at least 1");
  impl_->max_batch = options.max_batch;
  impl_->gl = std::make_unique<GlThread>(options.device);
  const std::string folder = options.shader_folder.empty() ? shaderFolder() : options.shader_folder;
  try
  {
    impl_->gl->run(
        [&] { impl_->pairs = std::make_unique<GpuPairChecker>(folder, options.traversal, options.max_batch); });
    setScene(std::move(scene));
  }
  catch (...)
  {
    impl_->gl->run([this] { impl_->pairs.reset(); });
    throw;
  }
}

BatchChecker::~BatchChecker()
{
  impl_->gl->run([this] { impl_->pairs.reset(); });
}

void BatchChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  GroupProblem whole;
  whole.problem = std::make_shared<const CollisionProblem>(makeProblem(*scene, "", &whole.report));
  const auto upload = [this](const CollisionProblem& problem, bool same_robot)
  { impl_->gl->run([&] { impl_->pairs->scene().setProblem(problem, same_robot); }); };
  try
  {
    upload(*whole.problem, impl_->scene && impl_->scene->robot == scene->robot);
  }
  catch (...)
  {
    if (impl_->scene)
      upload(*impl_->groups.at("").problem, false);
    impl_->selected_group.clear();
    throw;
  }
  impl_->scene = std::move(scene);
  impl_->forest.reset();
  impl_->groups.clear();
  impl_->groups.emplace("", std::move(whole));
  impl_->selected_group.clear();
}

BatchResult BatchChecker::check(const double* states, std::size_t count, const std::string& group_name)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  GroupProblem& group = impl_->groupProblem(group_name);
  refuseNonFinite(*impl_->scene->robot, states, count);
  BatchResult result;
  result.revision = impl_->scene->revision;
  result.valid.assign(count, 1);
  result.colliding.assign(count, { -1, -1 });
  if (impl_->selected_group != group_name)
  {
    impl_->gl->run([&] { impl_->pairs->scene().selectPairs(*group.problem); });
    impl_->selected_group = group_name;
  }

  const auto start = std::chrono::steady_clock::now();
  const std::size_t width = impl_->scene->robot->variables().size();
  const std::vector<Geometry>& robot = group.problem->robot;
  const std::vector<Geometry>& world = group.problem->world;
  std::vector<std::size_t> undecided;
  for (std::size_t begin = 0; begin < count; begin += impl_->max_batch)
  {
    const std::size_t part = std::min(impl_->max_batch, count - begin);
    const std::vector<float> poses = impl_->instancePoses(states + begin * width, part);
    Verdicts verdicts;
    impl_->gl->run([&] { impl_->pairs->check(poses.data(), part, verdicts); });
    for (std::size_t i = 0; i < part; ++i)
    {
      if (verdicts.flags[i] & STATE_HIT)
      {
        const auto [a, b] = GpuPairChecker::pairOf(verdicts.hits[i]);
        const Geometry& other = b < robot.size() ? robot[b] : world[b - robot.size()];
        result.valid[begin + i] = 0;
        result.colliding[begin + i] = { robot[a].body, other.body };
      }
      else if (verdicts.flags[i] & STATE_UNDECIDED)
        undecided.push_back(begin + i);
    }
  }
  if (!undecided.empty())
    impl_->settleOnCpu(group, states, undecided, result);
  result.undecided_states = undecided.size();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

SceneReport BatchChecker::report(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->groupProblem(group).report;
}

std::string BatchChecker::deviceName() const { return impl_->gl->device().renderer; }
}  // namespace gpu_planning_scene
