#include "gpu_planning_scene/batch_checker.h"

#include <utility>

#include "collision/batch/scheduler.h"
#include "collision/checkers/open_checker.h"

namespace gpu_planning_scene::core
{
BatchChecker::BatchChecker(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options)
  : BatchChecker(schedulerOf(options, openGpuDevice))
{
  scheduler_->openDevices(std::move(scene), options.device == "all");
}

BatchChecker::BatchChecker(std::unique_ptr<Scheduler> scheduler) : scheduler_(std::move(scheduler)) {}

BatchChecker::~BatchChecker() = default;

void BatchChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  scheduler_->setScene(std::move(scene));
}

BatchResult BatchChecker::checkBatch(const StateBatch& batch)
{
  return scheduler_->check(batch);
}

SceneReport BatchChecker::report(const std::string& group)
{
  return scheduler_->report(group);
}

GpuWork BatchChecker::lastWork() const
{
  return scheduler_->lastWork();
}

DeviceHistory BatchChecker::history() const
{
  return scheduler_->history();
}

std::string BatchChecker::deviceWarning() const
{
  return scheduler_->deviceWarning();
}

std::string BatchChecker::deviceName() const
{
  return scheduler_->deviceName();
}
}  // namespace gpu_planning_scene::core
