#include "collision/checkers/open_checker.h"

#include <vector>

#include "collision/checkers/device_group.h"
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

/// A CpuChecker in place of a device.
class CpuInstead : public CpuChecker
{
 public:
  CpuInstead(std::shared_ptr<const PlanningScene> scene, const CheckerOptions& options, std::string reason)
    : CpuChecker(std::move(scene), options), reason_(std::move(reason))
  {
  }

  std::string deviceWarning() const override
  {
    return "the GL device cannot check this scene, so the CPU checks all states; reason: " + reason_;
  }

 private:
  std::string reason_;
};
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

std::unique_ptr<StateChecker> openCheckerOrCpu(const std::shared_ptr<const PlanningScene>& scene,
                                               const BatchCheckerOptions& options)
{
  try
  {
    return openChecker(scene, options);
  }
  catch (const Error& error)
  {
    if ((options.device != "auto" && options.device != "all") || !hasDevice())
      throw;
    return std::make_unique<CpuInstead>(scene, options, error.what());  // throws if the scene or an option is not valid
  }
}
}  // namespace gpu_planning_scene::core
