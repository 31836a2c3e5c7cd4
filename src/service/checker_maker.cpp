#include "service/checker_maker.h"

#include <atomic>
#include <utility>

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
  CheckerMaker(const BatchCheckerOptions& options, const ResilientOptions& resilience, OpenDevice open_device,
               std::function<void(const std::string&)> warn)
    : options_(options),
      resilience_(resilience),
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
    return opened_ ? onDevice(scene, ResilientChecker::Opening::Later) : first(scene);
  }

  std::shared_ptr<StateChecker> onDevice(const Scene& scene, ResilientChecker::Opening opening) const
  {
    const auto device = [options = options_, open = open_device_](const Scene& its_scene)
    { return open(its_scene, options); };
    const auto cpu = [options = options_](const Scene& its_scene)
    { return std::make_unique<CpuChecker>(its_scene, options); };
    return std::make_shared<ResilientChecker>(scene, device, cpu, resilience_, opening);
  }

  /// A device that the user has named must work. The devices "auto" and "all" need not exist.
  std::shared_ptr<StateChecker> first(const Scene& scene)
  {
    try
    {
      auto checker = onDevice(scene, ResilientChecker::Opening::AtStart);
      opened_ = true;
      return checker;
    }
    catch (const Error& error)
    {
      if (options_.device != "auto" && options_.device != "all")
        throw;
      auto checker = std::make_shared<CpuChecker>(scene, options_);  // throws Error if the scene is invalid
      cpu_only_ = true;
      warn_(std::string("No GL device can be used, so the CPU checks all states until the node is started again. ") +
            "Reason: " + error.what());
      return checker;
    }
  }

  const BatchCheckerOptions options_;
  const ResilientOptions resilience_;
  const OpenDevice open_device_;
  const std::function<void(const std::string&)> warn_;
  std::atomic<bool> opened_{false};
  std::atomic<bool> cpu_only_;
};
}  // namespace

CheckServer::MakeChecker makeResilientCheckers(const BatchCheckerOptions& options, const ResilientOptions& resilience,
                                               const OpenDevice& open_device,
                                               const std::function<void(const std::string&)>& warn)
{
  const auto maker = std::make_shared<CheckerMaker>(options, resilience, open_device, warn);
  return [maker](const Scene& scene) { return maker->make(scene); };
}
}  // namespace gpu_planning_scene::core
