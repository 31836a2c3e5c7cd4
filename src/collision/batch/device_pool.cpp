#include "collision/batch/device_pool.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace gpu_planning_scene::core
{
namespace
{
// Before the paces are known, devices join batches of this many states.
constexpr std::size_t kLeastForDevice = 4096;
// A device joins if the cores alone would take this many times the device's latency.
constexpr double kLatencies = 2.0;
// A part is this fraction of the share of the waiting states that the device would get by its rate.
constexpr double kAhead = 0.5;
constexpr double kFirstShare = 0.25;  // while the rates are not known

constexpr std::size_t kLeastForRate = 1024;  // states; fewer say little about the rate
constexpr double kNewest = 0.5;              // weight of the newest batch
constexpr double kForgetting = 0.9;          // factor of a latency, for each batch that the device did not join

void learnRate(double& known, std::size_t states, double seconds)
{
  if (states < kLeastForRate || seconds <= 0.0)
    return;
  const double rate = static_cast<double>(states) / seconds;
  known = known == 0.0 ? rate : known + kNewest * (rate - known);
}
}  // namespace

DevicePool::DevicePool(std::vector<std::unique_ptr<DeviceWorker>> devices, bool device_only)
  : device_only_(device_only), devices_(std::move(devices))
{
}

DevicePool::~DevicePool()
{
  for (const auto& device : devices_)
    device->stop();  // so that they end at the same time
}

void DevicePool::open(const DeviceTask& task, bool one_suffices)
{
  std::exception_ptr error;
  bool is_one_open = false;
  for (const auto& device : devices_)
    try
    {
      device->open(task);
      is_one_open = true;
    }
    catch (const std::exception&)
    {
      if (!one_suffices)
        throw;
      error = error ? error : std::current_exception();
    }
  if (error && !is_one_open)
    std::rethrow_exception(error);
}

void DevicePool::prepare(const DeviceTask& task)
{
  for (const auto& device : devices_)
    device->prepare(task);
}

bool DevicePool::waitFor(std::chrono::milliseconds time)
{
  return std::all_of(
      devices_.begin(), devices_.end(), [time](const auto& device) { return device->waitFor(time); });
}

void DevicePool::abandonOverdue()
{
  for (const auto& device : devices_)
    device->abandonIfOverdue();
}

DevicePool::Paces DevicePool::pacesOf(const std::string& group) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known = paces_.find(group);
  Paces paces = known == paces_.end() ? Paces() : known->second;
  paces.devices.resize(devices_.size());
  return paces;
}

bool DevicePool::isDeviceOnly() const
{
  return device_only_ || std::any_of(
                             devices_.begin(), devices_.end(), [](const auto& device) { return device->isSoftware(); });
}

bool DevicePool::pays(const DeviceMean& device, double cores, std::size_t waiting) const
{
  if (isDeviceOnly())
    return waiting != 0;
  return device.rate == 0.0 || cores == 0.0 ? waiting >= kLeastForDevice
                                            : static_cast<double>(waiting) > kLatencies * cores * device.latency;
}

bool DevicePool::suits(const std::string& group, std::size_t waiting) const
{
  const Paces paces = pacesOf(group);
  for (std::size_t i = 0; i < devices_.size(); ++i)
    if (devices_[i]->isFree() && (devices_[i]->isClosed() || pays(paces.devices[i], paces.cores, waiting)))
      return true;
  return false;
}

bool DevicePool::join(const std::shared_ptr<Batch>& batch, const DeviceTask& task, const std::string& group)
{
  const Paces paces = pacesOf(group);
  double together = paces.cores;
  for (const DeviceMean& device : paces.devices)
    together += device.rate;
  bool has_joined = false;
  for (std::size_t i = 0; i < devices_.size(); ++i)
  {
    const double rate = paces.devices[i].rate;
    const double share = isDeviceOnly() ? kAhead / static_cast<double>(devices_.size())
                         : rate == 0.0  ? kFirstShare
                                        : kAhead * rate / together;
    if (batch->hasJoined(i))
      continue;
    if (pays(paces.devices[i], paces.cores, batch->waitingCount()))
      has_joined = devices_[i]->start(batch, task, i, share) || has_joined;
    else if (devices_[i]->isClosed())
      devices_[i]->prepare(task);
  }
  return has_joined;
}

void DevicePool::learn(const Batch& batch, const std::string& group, std::size_t core_states, double core_seconds)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  Paces& paces = paces_[group];
  paces.devices.resize(devices_.size());
  learnRate(paces.cores, core_states, core_seconds);
  for (std::size_t i = 0; i < devices_.size(); ++i)
  {
    DeviceMean& known = paces.devices[i];
    const DevicePace pace = batch.paceOf(i);
    // A device with a latency that was long once joins no batch, so it would never show that it is shorter now.
    if (pace.states == 0 && batch.count() >= kLeastForDevice)
      known.latency *= kForgetting;
    // In its first batch, a driver may still compile.
    if (pace.states == 0 || ++known.batches == 1)
      continue;
    learnRate(known.rate, pace.states, pace.seconds);
    known.latency = known.latency == 0.0 ? pace.first_seconds : std::min(known.latency, pace.first_seconds);
  }
}

void DevicePool::noteProofs(const std::string& group, ProofStage stage)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  Paces& paces = paces_[group];
  if (stage > paces.proofs)
    paces = {stage, 0.0, {}};
}

void DevicePool::forgetPaces()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  paces_.clear();
}

bool DevicePool::isUnusable() const
{
  return !devices_.empty() &&
         std::all_of(
             devices_.begin(), devices_.end(), [](const auto& device) { return device->history().on_cpu; });
}

std::string DevicePool::name() const
{
  std::string names;
  for (const auto& device : devices_)
    if (const std::string name = device->name(); !name.empty() && !device->history().on_cpu)
      names += (names.empty() ? "" : " + ") + name;
  return names.empty() ? "CPU" : names;
}

std::string DevicePool::warning() const
{
  std::string warnings;
  const auto add = [&warnings](const std::string& warning)
  { warnings += (warnings.empty() || warning.empty() ? "" : "; ") + warning; };
  for (const auto& device : devices_)
    if (const DeviceHistory history = device->history(); !history.on_cpu)
      add(device->fault());
    else if (devices_.size() == 1)
      add("the device has failed, so the CPU checks the states: " + history.last_error);
    else
      add("the device " + device->name() + " has failed and is not used: " + history.last_error);
  return warnings;
}

DeviceHistory DevicePool::history() const
{
  DeviceHistory sum;
  sum.on_cpu = isUnusable();
  for (const auto& device : devices_)
  {
    const DeviceHistory history = device->history();
    sum.losses += history.losses;
    sum.rebuilds += history.rebuilds;
    sum.rebuild_failed = sum.rebuild_failed || history.rebuild_failed;
    if (!history.last_error.empty())
      sum.last_error = history.last_error;
  }
  return sum;
}
}  // namespace gpu_planning_scene::core
