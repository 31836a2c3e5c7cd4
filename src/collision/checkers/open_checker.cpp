#include "collision/checkers/open_checker.h"

#include <utility>
#include <vector>

#include "collision/checkers/device_group.h"
#include "collision/checkers/fallback_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
bool hasDevice()
{
  try
  {
    return !listDevices().empty();
  }
  catch (const Error&)
  {
    return false;  // a library of EGL or OpenGL is missing
  }
}

std::unique_ptr<StateChecker> openOne(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options)
{
  if (options.device == "cpu")
    return std::make_unique<CpuChecker>(std::move(scene), options);
  try
  {
    return std::make_unique<BatchChecker>(std::move(scene), options);
  }
  catch (const Error& error)
  {
    if (hasDevice())
      throw;
    throw Error(std::string(error.what()) + "; or choose the device 'cpu', which needs no GPU");
  }
}
}  // namespace

std::unique_ptr<StateChecker> openChecker(std::shared_ptr<const PlanningScene> scene,
                                          const BatchCheckerOptions& options)
{
  const std::vector<std::string> devices = devicesOf(options.device);
  const auto open = [&options](std::shared_ptr<const PlanningScene> its_scene, const std::string& device)
  {
    BatchCheckerOptions its_options = options;
    its_options.device = device;
    return openOne(std::move(its_scene), its_options);
  };
  if (devices.size() == 1)
    return open(std::move(scene), devices.front());
  return std::make_unique<DeviceGroup>(scene, devices, open);
}

std::unique_ptr<StateChecker> openWithFallback(std::shared_ptr<const PlanningScene> scene,
                                               const BatchCheckerOptions& options,
                                               std::function<void(const std::string&)> warn)
{
  const bool needs_no_device = options.device == "auto" || options.device == "all";
  if (!needs_no_device || options.max_batch == 0)  // openChecker refuses this option, which is no fault of a device
    return openChecker(std::move(scene), options);
  try
  {
    const auto open = [options](std::shared_ptr<const PlanningScene> its_scene)
    { return openChecker(std::move(its_scene), options); };
    return std::make_unique<FallbackChecker>(scene, open, options, warn);
  }
  catch (const Error& error)
  {
    if (!hasDevice())
      throw;
    auto checker = std::make_unique<CpuChecker>(std::move(scene), options);  // throws Error if the scene is invalid
    warn(std::string("the device cannot be used, so the CPU checks the states: ") + error.what());
    return checker;
  }
}
}  // namespace gpu_planning_scene::core
