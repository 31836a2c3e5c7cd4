#include "collision/checkers/open_checker.h"

#include <algorithm>
#include <utility>

#include "collision/batch/scheduler.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
std::vector<std::string> devicesOf(const std::string& selection)
{
  std::vector<std::string> devices;
  if (selection == "all")
  {
    for (const Device& device : listDevices())
      if (!device.software)
        devices.push_back(std::to_string(device.index));
    return devices.empty() ? std::vector<std::string>{"auto"} : devices;
  }
  for (std::size_t begin = 0; begin <= selection.size();)
  {
    const std::size_t end = std::min(selection.find('+', begin), selection.size());
    devices.push_back(selection.substr(begin, end - begin));
    if (devices.back().empty())
      throw Error("the device '" + selection + "' has an empty part; give names or numbers with + between them: 0+1");
    begin = end + 1;
  }
  return devices;
}

namespace
{
/// Whether the cores are the better choice for "auto" and "all": there are devices, but no GPU among them. A software
/// renderer runs on the cores, and is slower than their own checks in each scene of the benchmark.
bool prefersCores(const BatchCheckerOptions& options)
{
  if (options.device_only || (options.device != "auto" && options.device != "all"))
    return false;
  const std::vector<Device> devices = listDevices();
  return !devices.empty() &&
         std::all_of(devices.begin(), devices.end(), [](const Device& device) { return device.software; });
}
}  // namespace

std::unique_ptr<Scheduler> schedulerOf(const BatchCheckerOptions& options, const OpenDevice& open)
{
  if (options.max_batch == 0)
    throw Error("max_batch is 0; it must be at least 1");
  std::vector<std::unique_ptr<DeviceWorker>> devices;
  if (prefersCores(options))
    return std::make_unique<Scheduler>(options, std::move(devices), false);
  for (const std::string& device : devicesOf(options.device))
  {
    BatchCheckerOptions its_options = options;
    its_options.device = device;
    devices.push_back(
        std::make_unique<DeviceWorker>([open, its_options] { return open(its_options); }, options.limits));
  }
  return std::make_unique<Scheduler>(options, std::move(devices), options.device_only);
}

std::unique_ptr<StateChecker> openChecker(std::shared_ptr<const PlanningScene> scene,
                                          const BatchCheckerOptions& options,
                                          const std::function<void(const std::string&)>& warn)
{
  if (options.device == "cpu")
    return std::make_unique<CpuChecker>(std::move(scene), options);
  try
  {
    return std::make_unique<BatchChecker>(scene, options);
  }
  catch (const Error& error)
  {
    if (options.max_batch == 0)
      throw;
    if (options.device != "auto" && options.device != "all")
      throw Error(std::string(error.what()) + "; or choose the device 'cpu', which needs no GPU");
    auto checker = std::make_unique<CpuChecker>(std::move(scene), options);  // throws if the scene is not valid
    warn(std::string("no device can be used, so the CPU checks the states: ") + error.what());
    return checker;
  }
}
}  // namespace gpu_planning_scene::core
