#include "collision/batch/batch.h"

#include <algorithm>
#include <utility>

namespace gpu_planning_scene::core
{
namespace
{
// A core's part: as small as possible without contention for the mutex, and a multiple of the lanes.
constexpr std::size_t kSmallestCorePart = 32;
constexpr std::size_t kLargestCorePart = 1024;
// A part is at most this fraction of a worker's share of the waiting states, so that the last parts are small.
constexpr std::size_t kPartsAhead = 4;
constexpr std::size_t kSmallestDevicePart = 1024;  // fewer states keep no device busy

/// Takes at most `most` states from the beginning of the last range.
StateRange takeFrom(std::vector<StateRange>& ranges, std::size_t most)
{
  StateRange& last = ranges.back();
  const StateRange taken{last.begin, std::min(most, last.count)};
  last.begin += taken.count;
  last.count -= taken.count;
  if (last.count == 0)
    ranges.pop_back();
  return taken;
}

/// Adds a state; consecutive ones make a range.
void addRow(std::size_t row, std::vector<StateRange>& ranges)
{
  if (!ranges.empty() && ranges.back().end() == row)
    ++ranges.back().count;
  else
    ranges.push_back({row, 1});
}

std::size_t statesOf(const std::vector<StateRange>& ranges)
{
  std::size_t count = 0;
  for (const StateRange& range : ranges)
    count += range.count;
  return count;
}
}  // namespace

Batch::Batch(const StateBatch& asked, std::optional<Margins> margins, std::size_t cores,
             const std::vector<std::size_t>& for_cores)
  : asked_(asked), margins_(std::move(margins)), cores_(std::max<std::size_t>(1, cores))
{
  result_.valid.assign(count(), 1);
  result_.colliding.assign(count(), kNoPair);
  std::size_t begin = 0;
  for (const std::size_t row : for_cores)
  {
    if (begin < row)
      waiting_.push_back({begin, row - begin});
    addRow(row, for_cores_);
    begin = row + 1;
  }
  if (begin < count())
    waiting_.push_back({begin, count() - begin});
  std::reverse(waiting_.begin(), waiting_.end());
  waiting_count_ = count() - for_cores.size();
}

void Batch::letCoresHelp(bool help)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  cores_help_ = help;
}

std::size_t Batch::available() const
{
  if (closed_)
    return 0;
  std::size_t states = statesOf(for_cores_);
  if (!cores_help_)
    return states;
  states += waiting_count_;
  if (states == 0 && hasOwner())
    for (const DevicePart& part : at_devices_)
      states += part.open_end - part.range.begin;
  return states;
}

std::size_t Batch::availableForCores() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return available();
}

/// The slowest device is not known, so the longest part is overtaken first.
StateRange Batch::overtake(std::size_t most)
{
  const auto open = [](const DevicePart& part) { return part.open_end - part.range.begin; };
  const auto longest = std::max_element(at_devices_.begin(), at_devices_.end(),
                                        [&](const DevicePart& a, const DevicePart& b) { return open(a) < open(b); });
  if (longest == at_devices_.end() || open(*longest) == 0)
    return {};
  const std::size_t taken = std::min(most, open(*longest));
  longest->open_end -= taken;
  return {longest->open_end, taken};
}

StateRange Batch::takeForCore(std::size_t most)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::size_t states = available();
  if (states == 0)
    return {};
  const std::size_t share = states / (kPartsAhead * cores_) / kSmallestCorePart * kSmallestCorePart;
  most = std::min(most, std::clamp(share, kSmallestCorePart, kLargestCorePart));
  if (!for_cores_.empty())
    return takeFrom(for_cores_, most);
  if (waiting_count_ == 0)
    return overtake(most);
  const StateRange taken = takeFrom(waiting_, most);
  waiting_count_ -= taken.count;
  return taken;
}

void Batch::answered(const StateRange& part)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  answered_ += part.count;
  if (answered_ == count())
    changed_.notify_all();
}

void Batch::waitForCores(std::chrono::steady_clock::time_point time)
{
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_until(lock, time, [this] { return closed_ || answered_ == count() || available() != 0; });
}

void Batch::join(std::size_t device)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  joined_.push_back(device);
}

void Batch::returnParts(std::size_t device)
{
  const auto is_its = [device](const DevicePart& part) { return part.device == device; };
  for (const DevicePart& part : at_devices_)
    if (is_its(part) && part.open_end > part.range.begin)
    {
      waiting_.push_back({part.range.begin, part.open_end - part.range.begin});
      waiting_count_ += waiting_.back().count;
    }
  at_devices_.erase(std::remove_if(at_devices_.begin(), at_devices_.end(), is_its), at_devices_.end());
  changed_.notify_all();
}

void Batch::giveBack(std::size_t device)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  returnParts(device);
}

void Batch::leave(std::size_t device)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  returnParts(device);
  joined_.erase(std::remove(joined_.begin(), joined_.end(), device), joined_.end());
  cores_help_ = cores_help_ || joined_.empty();
}

StateRange Batch::takeForDevice(std::size_t device, std::size_t most, double share)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (closed_ || waiting_count_ == 0 || std::find(joined_.begin(), joined_.end(), device) == joined_.end())
    return {};
  if (cores_help_ || joined_.size() > 1)
  {
    const auto ahead = static_cast<std::size_t>(share * static_cast<double>(waiting_count_));
    most = std::min(most, std::max(kSmallestDevicePart, ahead));
  }
  const StateRange taken = takeFrom(waiting_, most);
  waiting_count_ -= taken.count;
  at_devices_.push_back({device, taken, taken.end()});
  return taken;
}

StateRange Batch::beginAnswer(std::size_t device, const StateRange& part)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (closed_)
    return {};
  const auto known =
      std::find_if(at_devices_.begin(), at_devices_.end(),
                   [&](const DevicePart& other) { return other.device == device && other.range.begin == part.begin; });
  if (known == at_devices_.end())
    return {};
  const StateRange states{part.begin, std::max(part.begin, std::min(part.end(), known->open_end)) - part.begin};
  known->range = {part.end(), known->range.end() - part.end()};
  if (known->range.begin >= known->open_end)
    at_devices_.erase(known);
  if (states.count != 0)
    ++writing_;
  return states;
}

void Batch::endAnswer(const StateRange& states, const std::vector<std::size_t>& undecided)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  answered_ += states.count - undecided.size();
  answered_by_devices_ += states.count - undecided.size();
  for (const std::size_t row : undecided)
    addRow(row, for_cores_);
  result_.undecided_states += undecided.size();
  --writing_;
  changed_.notify_all();
}

void Batch::add(const GpuWork& work)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  work_ += work;
}

GpuWork Batch::work() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return work_;
}

std::size_t Batch::devices() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return joined_.size();
}

std::size_t Batch::answeredCount() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return answered_;
}

std::size_t Batch::answeredByDevices() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return answered_by_devices_;
}

void Batch::waitForDevices()
{
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return joined_.empty(); });
}

void Batch::close()
{
  std::unique_lock<std::mutex> lock(mutex_);
  closed_ = true;
  changed_.notify_all();
  changed_.wait(lock, [this] { return writing_ == 0; });
}

void Batch::fail(std::exception_ptr error)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
  if (!error_)
    error_ = std::move(error);
  changed_.notify_all();
}

bool Batch::isClosed() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return closed_;
}

std::exception_ptr Batch::error() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return error_;
}
}  // namespace gpu_planning_scene::core
