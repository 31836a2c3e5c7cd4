#include "node/checker_maker.h"

#include <atomic>

#include <ros/console.h>

#include "gpu_planning_scene/cpu_checker.h"

namespace gpu_planning_scene::core
{
CheckServer::MakeChecker checkerMaker(const BatchCheckerOptions& options, const ResilientOptions& resilience,
                                      const OpenDevice& open_device, Diagnostics& diagnostics)
{
  const auto cpu = [options](std::shared_ptr<const PlanningScene> scene) -> std::unique_ptr<StateChecker>
  { return std::make_unique<CpuChecker>(std::move(scene), options); };
  const auto device = [options, open_device](std::shared_ptr<const PlanningScene> scene)
  { return open_device(std::move(scene), options); };
  // Each check queue and the plan service has a copy of the function below; the copies share this flag.
  const auto started = std::make_shared<std::atomic<bool>>(false);
  return [=, &diagnostics](std::shared_ptr<const PlanningScene> scene)
  {
    std::shared_ptr<StateChecker> checker;
    if (options.device == "cpu")
      checker = cpu(std::move(scene));
    else
      checker = std::make_shared<ResilientChecker>(
          std::move(scene), device, cpu, resilience,
          *started ? ResilientChecker::Opening::Later : ResilientChecker::Opening::AtStart);
    *started = true;
    if (const std::string warning = checker->deviceWarning(); !warning.empty())
      ROS_WARN_STREAM(warning);
    diagnostics.watch(checker);
    return checker;
  };
}
}  // namespace gpu_planning_scene::core
