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

// The devices take shares of a batch from a common list until it is empty, so a fast device takes more of them. A share
// whose device was lost goes back to the list. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kSmallestShare = 16'384;  // fewer states are not worth a second device
constexpr std::size_t kBusyShare = 65'536;      // fewer states do not keep a GPU busy
constexpr std::size_t kLargestShare = 262'144;  // more states would keep the caller waiting for the slowest device
constexpr std::size_t kSharesPerDevice = 4;

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

struct Message
{
  bool is_loss;  // of a DeviceLost
  std::string text;
};

Message messageOf(const std::exception_ptr& error)
{
  try
  {
    std::rethrow_exception(error);
  }
  catch (const DeviceLost& lost)
  {
    return {true, lost.what()};
  }
  catch (const std::exception& other)
  {
    return {false, other.what()};
  }
}

/// The neighbourhoods of `count` states from `begin` on, with the rows of the travel that they use.
JointNeighbourhood neighbourhoodsOf(const JointNeighbourhood& around, std::size_t begin, std::size_t count,
                                    const RobotModel& robot)
{
  if (count == 0)
    return {};
  const auto rows = around.rows.begin() + static_cast<std::ptrdiff_t>(begin);
  JointNeighbourhood share;
  share.rows.assign(rows, rows + static_cast<std::ptrdiff_t>(count));
  const auto [least, most] = std::minmax_element(share.rows.begin(), share.rows.end());
  const std::uint32_t first = *least;
  const std::size_t end = *most + std::size_t{1};
  const auto copy = [first, end](const auto& from, std::size_t width, auto& to)
  {
    to.assign(from.begin() + static_cast<std::ptrdiff_t>(first * width),
              from.begin() + static_cast<std::ptrdiff_t>(end * width));
  };
  copy(around.travel, robot.joints().size(), share.travel);
  if (!around.centers.empty())
    copy(around.centers, robot.variables().size(), share.centers);
  share.spread = around.spread;
  for (std::uint32_t& row : share.rows)
    row -= first;
  return share;
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
    if (devices.back().empty())
      throw Error("the device '" + selection + "' has an empty part; give names or numbers with + between them: 0+1");
    begin = end + 1;
  }
  return devices;
}

/// A batch while the devices check its shares.
struct DeviceGroup::Batch
{
  const double* states;
  std::size_t count;
  std::size_t width;
  const std::string& group;
  const JointNeighbourhood* around;
  std::size_t per_share = 0;
  std::vector<BatchResult> results = {};  // of each share
  std::mutex mutex = {};
  std::vector<std::size_t> waiting = {};  // shares, the first one last

  /// Cuts the batch into equal shares of kBusyShare to kLargestShare states: up to kSharesPerDevice for each device,
  /// and more only if these were too large. A batch that is too small for that is one share for each device, but no
  /// share has fewer than kSmallestShare states, unless the batch has fewer.
  void cut(std::size_t devices)
  {
    const auto shares_of = [this](std::size_t size) { return std::max<std::size_t>(1, (count + size - 1) / size); };
    const std::size_t least = std::clamp(count / devices, kSmallestShare, kBusyShare);
    const std::size_t wanted = std::min(count / least, devices * kSharesPerDevice);
    const std::size_t shares = std::max(wanted, shares_of(kLargestShare));
    per_share = std::max<std::size_t>(1, (count + shares - 1) / shares);
    results.resize(shares_of(per_share));
    for (std::size_t i = results.size(); i-- > 0;)
      waiting.push_back(i);
  }
  std::optional<std::size_t> take()
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (waiting.empty())
      return std::nullopt;
    const std::size_t share = waiting.back();
    waiting.pop_back();
    return share;
  }
  void giveBack(std::size_t share)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    waiting.push_back(share);
  }
};

DeviceGroup::DeviceGroup(const std::shared_ptr<const PlanningScene>& scene, const std::vector<std::string>& devices,
                         const Open& open)
  : scene_(scene)
{
  for (const std::string& device : devices)
    devices_.push_back(open(scene, device));
}

void DeviceGroup::requireDevice() const
{
  if (devices_.empty())
    throw DeviceLost(lost_);
}

/// Runs the action on the first `count` devices at once.
DeviceGroup::Errors DeviceGroup::onEachDevice(std::size_t count, const std::function<void(StateChecker&)>& action)
{
  Errors errors(count);
  const auto run = [&](std::size_t i) { errors[i] = thrownBy([&] { action(*devices_[i]); }); };
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < count; ++i)
    others.push_back(std::async(std::launch::async, run, i));
  run(0);
  for (const std::future<void>& other : others)
    other.wait();
  return errors;
}

/// Forgets the devices that were lost. Returns the first other error; null: none. Throws DeviceLost if no device is
/// left.
std::exception_ptr DeviceGroup::dropLost(const Errors& errors)
{
  std::exception_ptr other;
  std::vector<std::unique_ptr<StateChecker>> left;
  for (std::size_t i = 0; i < devices_.size(); ++i)
  {
    const std::exception_ptr error = i < errors.size() ? errors[i] : nullptr;
    if (const Message message = error ? messageOf(error) : Message{}; message.is_loss)
    {
      addLine("the device " + devices_[i]->deviceName() + " was lost: " + message.text, "; ", lost_);
      continue;
    }
    if (!other)
      other = error;
    left.push_back(std::move(devices_[i]));
  }
  devices_ = std::move(left);
  requireDevice();
  return other;
}

/// Gives the old scene to all devices. A device that does not take it would answer for another scene, so it is dropped.
void DeviceGroup::restoreScene()
{
  Errors errors = onEachDevice(devices_.size(), [this](StateChecker& device) { device.setScene(scene_); });
  for (std::exception_ptr& error : errors)
    if (error)
      error = std::make_exception_ptr(DeviceLost("it has not taken the old scene again: " + messageOf(error).text));
  dropLost(errors);
}

void DeviceGroup::setScene(std::shared_ptr<const PlanningScene> scene)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  requireDevice();
  const Errors errors = onEachDevice(devices_.size(), [&scene](StateChecker& device) { device.setScene(scene); });
  if (const std::exception_ptr refusal = dropLost(errors))
  {
    restoreScene();
    std::rethrow_exception(refusal);
  }
  scene_ = std::move(scene);
}

/// Checks waiting shares until none is left.
void DeviceGroup::checkShares(StateChecker& device, Batch& batch) const
{
  while (const std::optional<std::size_t> share = batch.take())
  {
    const std::size_t begin = *share * batch.per_share;
    const std::size_t count = std::min(batch.per_share, batch.count - begin);
    try
    {
      JointNeighbourhood around;
      if (batch.around)
        around = neighbourhoodsOf(*batch.around, begin, count, *scene_->robot);
      BatchResult& result = batch.results[*share];
      result = device.check(batch.states + begin * batch.width, count, batch.group, batch.around ? &around : nullptr);
      if (result.revision != scene_->revision)
        throw DeviceLost("it has the scene of another revision");
    }
    catch (const DeviceLost&)
    {
      batch.giveBack(*share);
      throw;
    }
  }
}

BatchResult DeviceGroup::check(const double* states, std::size_t count, const std::string& group,
                               const JointNeighbourhood* around)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  requireDevice();
  // Here, so that the error names the state's number in the whole batch.
  validateStates(*scene_->robot, states, count);
  if (around)
    validateNeighbourhood(*scene_->robot, *around, count);
  const auto start = std::chrono::steady_clock::now();
  Batch batch{states, count, scene_->robot->variables().size(), group, around};
  batch.cut(devices_.size());
  while (!batch.waiting.empty())
  {
    const std::size_t used = std::min(devices_.size(), batch.waiting.size());
    if (const std::exception_ptr error =
            dropLost(onEachDevice(used, [&](StateChecker& device) { checkShares(device, batch); })))
      std::rethrow_exception(error);
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
  requireDevice();
  std::optional<SceneReport> report;
  Errors errors;
  for (const auto& device : devices_)
    errors.push_back(thrownBy(
        [&]
        {
          SceneReport one = device->report(group);
          if (report)
            addDecided(one.decided, report->decided);
          else
            report = std::move(one);
        }));
  if (const std::exception_ptr error = dropLost(errors))
    std::rethrow_exception(error);
  return *report;  // a device is left, so it has reported
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
