#include "gpu_planning_scene/batch_checker.h"

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "collision/batch_engine.h"
#include "collision/state_rows.h"

namespace gpu_planning_scene
{
struct BatchChecker::Impl
{
  struct GroupProblem
  {
    SceneReport report;
    std::shared_ptr<const CollisionProblem> problem;
  };

  explicit Impl(const BatchCheckerOptions& options) : engine(options) {}

  const GroupProblem& groupProblem(const std::string& group)
  {
    const auto known = groups.find(group);
    if (known != groups.end())
      return known->second;
    GroupProblem made;
    made.problem = std::make_shared<const CollisionProblem>(makeProblem(*scene, group, &made.report));
    return groups.emplace(group, std::move(made)).first->second;
  }

  std::mutex mutex;
  BatchEngine engine;
  std::shared_ptr<const PlanningScene> scene;
  std::map<std::string, GroupProblem> groups;
  std::optional<std::string> selected_group;  // whose pairs the engine has now
};

BatchChecker::BatchChecker(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options)
  : impl_(std::make_unique<Impl>(options))
{
  BatchChecker::setScene(std::move(scene));
}

BatchChecker::~BatchChecker() = default;

void BatchChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  refuseMissingRobot(scene);
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  Impl::GroupProblem whole;
  whole.problem = std::make_shared<const CollisionProblem>(makeProblem(*scene, "", &whole.report));
  impl_->engine.setProblem(whole.problem);
  impl_->scene = std::move(scene);
  impl_->groups.clear();
  impl_->groups.emplace("", std::move(whole));
  impl_->selected_group = "";
}

BatchResult BatchChecker::check(const double* states, std::size_t count, const std::string& group)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  const RobotModel& robot = *impl_->scene->robot;
  const std::size_t width = robot.variables().size();
  const auto& problem = impl_->groupProblem(group).problem;
  refuseNonFinite(robot, states, count);
  if (impl_->selected_group != group)
  {
    impl_->selected_group.reset();  // for as long as it is not known which pairs the engine has
    impl_->engine.selectPairs(problem);
    impl_->selected_group = group;
  }
  BatchResult result;
  result.revision = impl_->scene->revision;
  const auto start = std::chrono::steady_clock::now();
  impl_->engine.check(
      count, robot.links().size(),
      [&](std::size_t row, Eigen::Isometry3d* poses) { robot.linkPoses(states + row * width, poses); }, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

SceneReport BatchChecker::report(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->groupProblem(group).report;
}

std::string BatchChecker::deviceWarning() const
{
  return impl_->engine.floatFault();
}

std::string BatchChecker::deviceName() const
{
  return impl_->engine.device().renderer;
}
}  // namespace gpu_planning_scene
