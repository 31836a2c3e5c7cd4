#include "collision/checkers/device_group.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <optional>
#include <utility>

#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"
#include "model/seconds_since.h"

// The devices take parts of a batch from a common list until it is empty, so a fast device takes more of them. A part
// whose device was lost goes back to the list. Own method.
namespace gpu_planning_scene::core
{
namespace
{
// A smaller part would not keep a GPU busy; a larger one would keep the caller waiting for the slowest device.
constexpr std::size_t kSmallestPart = 16'384;
constexpr std::size_t kLargestPart = 262'144;
constexpr std::size_t kPartsPerDevice = 4;

/// The result of `action`'s call: what it throws, or nothing.
template <class Action>
std::exception_ptr thrownBy(const Action& action)
{
  try
  {
    action();
    return nullptr;
  }
  catch (...)
  {
    return std::current_exception();
  }
}

/// The message of a lost device. No value: the error is another one, or there is none.
std::optional<std::string> lossOf(const std::exception_ptr& error)
{
  try
  {
    if (error)
      std::rethrow_exception(error);
  }
  catch (const DeviceLost& lost)
  {
    return lost.what();
  }
  catch (...)  // NOLINT(bugprone-empty-catch): the caller throws it again
  {
  }
  return std::nullopt;
}

void addLine(const std::string& line, const std::string& separator, std::string& all)
{
  all += (all.empty() || line.empty() ? "" : separator) + line;
}

/// Adds the states that another device's CPU checks have decided.
void addDecided(const std::vector<DecidedStates>& added, std::vector<DecidedStates>& all)
{
  const auto total = [](const std::vector<DecidedStates>& stages)
  {
    double states = 0.0;
    for (const DecidedStates& stage : stages)
      states += static_cast<double>(stage.states);
    return states;
  };
  const double before = total(all);
  const double more = total(added);
  for (const DecidedStates& stage : added)
  {
    const auto known =
        std::find_if(all.begin(), all.end(), [&stage](const DecidedStates& other) { return other.by == stage.by; });
    if (known == all.end())
    {
      all.push_back(stage);
      continue;
    }
    if (before + more > 0.0)
      known->nanoseconds = (before * known->nanoseconds + more * stage.nanoseconds) / (before + more);
    known->states += stage.states;
  }
}
}  // namespace

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
    begin = end + 1;
  }
  return devices;
}

/// A batch while the devices check its parts.
struct DeviceGroup::Batch
{
  const double* states;
  std::size_t count;
  std::size_t width;
  const std::string& group;
  const JointNeighbourhood* around;
  std::size_t per_part = 0;
  std::vector<BatchResult> results = {};  // of each part
  std::mutex mutex = {};
  std::vector<std::size_t> waiting = {};  // parts, the first one last

  /// Cuts the batch into parts for a number of devices.
  void cut(std::size_t devices)
  {
    per_part = std::clamp(count / (devices * kPartsPerDevice), kSmallestPart, kLargestPart);
    results.resize(std::max<std::size_t>(1, (count + per_part - 1) / per_part));
    for (std::size_t i = results.size(); i-- > 0;)
      waiting.push_back(i);
  }
  std::optional<std::size_t> take()
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (waiting.empty())
      return std::nullopt;
    const std::size_t part = waiting.back();
    waiting.pop_back();
    return part;
  }
  void giveBack(std::size_t part)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    waiting.push_back(part);
  }
};

DeviceGroup::DeviceGroup(const std::shared_ptr<const PlanningScene>& scene, const std::vector<std::string>& devices,
                         const Open& open)
  : scene_(scene)
{
  for (const std::string& device : devices)
    devices_.push_back(open(scene, device));
}

/// Forgets the devices that were lost. `errors`: of the first devices. Throws any other error, and DeviceLost if no
/// device is left.
void DeviceGroup::dropLost(const std::vector<std::exception_ptr>& errors)
{
  std::exception_ptr other;
  std::vector<std::unique_ptr<StateChecker>> left;
  for (std::size_t i = 0; i < devices_.size(); ++i)
  {
    const std::exception_ptr error = i < errors.size() ? errors[i] : nullptr;
    if (const std::optional<std::string> loss = lossOf(error))
    {
      addLine("the device " + devices_[i]->deviceName() + " was lost: " + *loss, "; ", lost_);
      continue;
    }
    if (error && !other)
      other = error;
    left.push_back(std::move(devices_[i]));
  }
  devices_ = std::move(left);
  if (devices_.empty())
    throw DeviceLost(lost_);
  if (other)
    std::rethrow_exception(other);
}

void DeviceGroup::setScene(std::shared_ptr<const PlanningScene> scene)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::exception_ptr> errors;
  for (const auto& device : devices_)
    errors.push_back(thrownBy([&] { device->setScene(scene); }));
  try
  {
    dropLost(errors);
  }
  catch (const DeviceLost&)
  {
    throw;
  }
  catch (...)
  {
    for (const auto& device : devices_)
      device->setScene(scene_);
    throw;
  }
  scene_ = std::move(scene);
}

/// Checks waiting parts until none is left.
void DeviceGroup::checkParts(StateChecker& device, Batch& batch) const
{
  while (const std::optional<std::size_t> part = batch.take())
  {
    const std::size_t begin = *part * batch.per_part;
    const std::size_t count = std::min(batch.per_part, batch.count - begin);
    try
    {
      JointNeighbourhood around;
      if (batch.around)
      {
        const auto first = batch.around->rows.begin() + static_cast<std::ptrdiff_t>(begin);
        around = {batch.around->travel, {first, first + static_cast<std::ptrdiff_t>(count)}};
      }
      batch.results[*part] =
          device.check(batch.states + begin * batch.width, count, batch.group, batch.around ? &around : nullptr);
    }
    catch (const DeviceLost&)
    {
      batch.giveBack(*part);
      throw;
    }
  }
}

BatchResult DeviceGroup::check(const double* states, std::size_t count, const std::string& group,
                               const JointNeighbourhood* around)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  // Here, so that the error names the state's number in the whole batch.
  validateStates(*scene_->robot, states, count);
  if (around)
    validateNeighbourhood(*scene_->robot, *around, count);
  const auto start = std::chrono::steady_clock::now();
  Batch batch{states, count, scene_->robot->variables().size(), group, around};
  batch.cut(devices_.size());
  while (!batch.waiting.empty())
  {
    std::vector<std::exception_ptr> errors(std::min(devices_.size(), batch.waiting.size()));
    const auto run = [&](std::size_t i) { errors[i] = thrownBy([&] { checkParts(*devices_[i], batch); }); };
    std::vector<std::future<void>> others;
    for (std::size_t i = 1; i < errors.size(); ++i)
      others.push_back(std::async(std::launch::async, run, i));
    run(0);
    for (const std::future<void>& other : others)
      other.wait();
    dropLost(errors);
  }
  BatchResult result = std::move(batch.results.front());
  for (std::size_t i = 1; i < batch.results.size(); ++i)
    result.append(batch.results[i]);
  result.seconds = secondsSince(start);
  return result;
}

SceneReport DeviceGroup::report(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  SceneReport report = devices_.front()->report(group);
  for (std::size_t i = 1; i < devices_.size(); ++i)
    addDecided(devices_[i]->report(group).decided, report.decided);
  return report;
}

std::string DeviceGroup::deviceName() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string names;
  for (const auto& device : devices_)
    addLine(device->deviceName(), " + ", names);
  return names;
}

std::string DeviceGroup::deviceWarning() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string warnings = lost_;
  for (const auto& device : devices_)
    addLine(device->deviceWarning(), "; ", warnings);
  return warnings;
}
}  // namespace gpu_planning_scene::core
