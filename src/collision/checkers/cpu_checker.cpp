#include "gpu_planning_scene/cpu_checker.h"

#include <utility>
#include <vector>

#include "collision/batch/scheduler.h"

namespace gpu_planning_scene::core
{
CpuChecker::CpuChecker(std::shared_ptr<const PlanningScene> scene, const CheckerOptions& options)
  : scheduler_(std::make_unique<Scheduler>(options, std::vector<std::unique_ptr<DeviceWorker>>(), false))
{
  CpuChecker::setScene(std::move(scene));
}

CpuChecker::~CpuChecker() = default;

void CpuChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  scheduler_->setScene(std::move(scene));
}

BatchResult CpuChecker::checkBatch(const StateBatch& batch)
{
  return scheduler_->check(batch);
}

SceneReport CpuChecker::report(const std::string& group)
{
  return scheduler_->report(group);
}

std::string CpuChecker::deviceName() const
{
  return "CPU";
}
}  // namespace gpu_planning_scene::core
