#include "gpu_planning_scene/cpu_checker.h"

#include <chrono>
#include <map>
#include <mutex>

#include "binned_sah.h"
#include "collision_problem.h"
#include "cpu_forest.h"
#include "cpu_traversal.h"
#include "state_rows.h"

namespace gpu_planning_scene
{
namespace
{
constexpr std::size_t kStatesPerChunk = 16;
}  // namespace

struct CpuChecker::Impl
{
  struct GroupProblem
  {
    SceneReport report;
    std::unique_ptr<const CpuTraversal> traversal;
  };

  CheckerOptions options;
  std::mutex mutex;
  std::shared_ptr<const PlanningScene> scene;
  std::shared_ptr<const CpuForest> forest;  // all groups have the same trees
  std::map<std::string, GroupProblem> groups;

  const GroupProblem& groupProblem(const std::string& group)
  {
    const auto known = groups.find(group);
    if (known != groups.end())
    {
      return known->second;
    }
    GroupProblem made;
    auto problem = std::make_shared<const CollisionProblem>(makeProblem(*scene, group, &made.report));
    if (!forest)
    {
      forest =
          std::make_shared<const CpuForest>(*problem, std::make_shared<const Forest>(buildBinnedSah(problem->trees)));
    }
    made.traversal = std::make_unique<const CpuTraversal>(problem, forest);
    return groups.emplace(group, std::move(made)).first->second;
  }
};

CpuChecker::CpuChecker(std::shared_ptr<const PlanningScene> scene, const CheckerOptions& options)
  : impl_(std::make_unique<Impl>())
{
  impl_->options = options;
  CpuChecker::setScene(std::move(scene));
}

CpuChecker::~CpuChecker() = default;

void CpuChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  refuseMissingRobot(scene);
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  Impl fresh;
  fresh.options = impl_->options;
  fresh.scene = std::move(scene);
  fresh.groupProblem("");
  impl_->scene = std::move(fresh.scene);
  impl_->forest = std::move(fresh.forest);
  impl_->groups = std::move(fresh.groups);
}

BatchResult CpuChecker::check(const double* states, std::size_t count, const std::string& group)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  const CpuTraversal& traversal = *impl_->groupProblem(group).traversal;
  refuseNonFinite(*impl_->scene->robot, states, count);
  const RobotModel& robot = *impl_->scene->robot;

  BatchResult result;
  result.revision = impl_->scene->revision;
  result.valid.assign(count, 1);
  result.colliding.assign(count, {-1, -1});
  const auto start = std::chrono::steady_clock::now();
  forChunks(count, kStatesPerChunk,
            [&, scratch = CpuTraversal::Scratch(), poses = std::vector<Eigen::Isometry3d>(robot.links().size())](
                std::size_t begin, std::size_t end) mutable
            {
              for (std::size_t i = begin; i < end; ++i)
              {
                robot.linkPoses(states + i * robot.variables().size(), poses.data());
                if (const auto pair = traversal.firstCollision(poses.data(), scratch))
                {
                  result.valid[i] = 0;
                  result.colliding[i] = *pair;
                }
              }
            });
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

SceneReport CpuChecker::report(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->groupProblem(group).report;
}

std::string CpuChecker::deviceName() const
{
  return "CPU";
}
}  // namespace gpu_planning_scene
