#include "service/checker_maker.h"

#include <atomic>
#include <utility>

#include "collision/batch/scheduler.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using Scene = std::shared_ptr<const PlanningScene>;

/// Makes the checkers of a program. Thread-safe.
class CheckerMaker
{
 public:
  CheckerMaker(const BatchCheckerOptions& options, OpenDevice open_device, std::function<void(const std::string&)> warn)
    : options_(options),
      open_device_(std::move(open_device)),
      warn_(std::move(warn)),
      cpu_only_(options.device == "cpu")
  {
  }

  std::shared_ptr<StateChecker> make(const Scene& scene)
  {
    std::shared_ptr<StateChecker> checker = open(scene);
    if (const std::string warning = checker->deviceWarning(); !warning.empty())
      warn_(warning);
    return checker;
  }

 private:
  std::shared_ptr<StateChecker> open(const Scene& scene)
  {
    if (cpu_only_)
      return std::make_shared<CpuChecker>(scene, options_);
    if (!opened_)
      return openFirst(scene);
    auto scheduler = schedulerOf(options_, open_device_);
    scheduler->setScene(scene);
    return std::make_shared<BatchChecker>(std::move(scheduler));
  }

  /// At the start: a device that the user has named must work. The devices "auto" and "all" need not exist.
  std::shared_ptr<StateChecker> openFirst(const Scene& scene)
  {
    try
    {
      auto scheduler = schedulerOf(options_, open_device_);
      scheduler->openDevices(scene, options_.device == "all");
      opened_ = true;
      return std::make_shared<BatchChecker>(std::move(scheduler));
    }
    catch (const Error& error)
    {
      if (options_.device != "auto" && options_.device != "all")
        throw;
      auto on_cpu = std::make_shared<CpuChecker>(scene, options_);  // throws if the scene is not valid
      cpu_only_ = true;
      warn_(std::string("No GL device can be used, so the CPU checks all states until the node is started again. ") +
            "Reason: " + error.what());
      return on_cpu;
    }
  }

  const BatchCheckerOptions options_;
  const OpenDevice open_device_;
  const std::function<void(const std::string&)> warn_;
  std::atomic<bool> opened_{false};
  std::atomic<bool> cpu_only_;
};
}  // namespace

MakeChecker makeCheckers(const BatchCheckerOptions& options, const OpenDevice& open_device,
                         const std::function<void(const std::string&)>& warn)
{
  const auto maker = std::make_shared<CheckerMaker>(options, open_device, warn);
  return [maker](const Scene& scene) { return maker->make(scene); };
}
}  // namespace gpu_planning_scene::core
