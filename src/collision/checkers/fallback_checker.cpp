#include "collision/checkers/fallback_checker.h"

#include <limits>
#include <utility>

#include "gpu_planning_scene/cpu_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
ResilientOptions withoutLimit()
{
  ResilientOptions options;
  options.device_seconds = std::numeric_limits<double>::infinity();
  return options;
}
}  // namespace

FallbackChecker::FallbackChecker(std::shared_ptr<const PlanningScene> scene, ResilientChecker::Make open,
                                 const BatchCheckerOptions& options, Warn warn)
  : checker_(
        std::move(scene), std::move(open),
        [options](std::shared_ptr<const PlanningScene> its_scene)
        { return std::make_unique<CpuChecker>(std::move(its_scene), options); },
        withoutLimit()),
    warn_(std::move(warn))
{
}

void FallbackChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  checker_.setScene(std::move(scene));
  tell();
}

BatchResult FallbackChecker::check(const double* states, std::size_t count, const std::string& group,
                                   const JointNeighbourhood* around)
{
  BatchResult result = checker_.check(states, count, group, around);
  tell();
  return result;
}

SceneReport FallbackChecker::report(const std::string& group)
{
  SceneReport report = checker_.report(group);
  tell();
  return report;
}

void FallbackChecker::tell()
{
  const DeviceHistory history = checker_.history();
  if (history.on_cpu && !on_cpu_.exchange(true))
    warn_("the device has failed, so the CPU checks the states: " + history.last_error);
  if (!history.on_cpu)
    on_cpu_ = false;
}
}  // namespace gpu_planning_scene::core
