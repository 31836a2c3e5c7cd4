#include "collision/batch/batch.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/finally.h"
#include "collision/problem/rows_without.h"

namespace gpu_planning_scene::core
{
namespace
{
// A core's part: as small as possible without contention for the mutex, and a multiple of the lanes.
constexpr std::size_t kSmallestCorePart = 32;
constexpr std::size_t kMostRanges = 64;  // of a core's part
// A part is at most this fraction of a worker's share of the waiting states, so that the last parts are small.
constexpr std::size_t kPartsAhead = 4;
constexpr std::size_t kSmallestDevicePart = 1024;  // fewer states keep no device busy

/// The value of BatchResult::valid for a state without an answer.
constexpr std::uint8_t kNoAnswer = 2;

/// Takes at most `most` states from the beginning of the last range.
StateRange takeFrom(std::vector<StateRange>& ranges, std::size_t& count, std::size_t most)
{
  StateRange& last = ranges.back();
  const StateRange taken{last.begin, std::min(most, last.count)};
  last.begin += taken.count;
  last.count -= taken.count;
  count -= taken.count;
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

void freeUnlessHit(const StateRange& states, std::vector<std::uint8_t>& valid)
{
  for (std::size_t i = states.begin; i < states.end(); ++i)
    valid[i] = valid[i] == kNoAnswer ? 1 : valid[i];
}
}  // namespace

Batch::Batch(std::size_t count, std::optional<Margins> margins, std::size_t cores)
  : count_(count), margins_(std::move(margins)), cores_(std::max<std::size_t>(1, cores)), waiting_count_(count)
{
  result_.valid.assign(count, kNoAnswer);
  result_.colliding.assign(count, kNoPair);
  if (count != 0)
    waiting_.push_back({0, count});
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
  if (!cores_help_)
    return undecided_count_;
  std::size_t states = undecided_count_ + waiting_count_;
  if (states == 0)
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
  const std::size_t taken = std::min(most, open(*longest));
  longest->open_end -= taken;
  return {longest->open_end, taken};
}

StateRange Batch::takeNext(std::size_t most)
{
  if (undecided_count_ != 0)
    return takeFrom(undecided_, undecided_count_, most);
  return waiting_count_ != 0 ? takeFrom(waiting_, waiting_count_, most) : overtake(most);
}

void Batch::takeForCore(std::size_t most, std::vector<StateRange>& part)
{
  part.clear();
  part.reserve(kMostRanges);  // now: a state that is taken and not recorded would be lost
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::size_t states = available();
  const std::size_t share = states / (kPartsAhead * cores_) / kSmallestCorePart * kSmallestCorePart;
  most = std::min(most, std::max(share, kSmallestCorePart));
  while (most != 0 && part.size() < kMostRanges && available() != 0)
  {
    part.push_back(takeNext(most));
    most -= part.back().count;
  }
}

void Batch::answered(const std::vector<StateRange>& part)
{
  std::size_t states = 0;
  for (const StateRange& range : part)
  {
    freeUnlessHit(range, result_.valid);
    states += range.count;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  answered_ += states;
  if (answered_ == count())
    changed_.notify_all();
}

void Batch::waitForCores(Clock::time_point time)
{
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_until(lock, time, [this] { return closed_ || answered_ == count() || available() != 0; });
}

void Batch::join(std::size_t device)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  joined_.push_back(device);
}

bool Batch::hasJoined(std::size_t device) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::find(joined_.begin(), joined_.end(), device) != joined_.end();
}

void Batch::returnParts(std::size_t device)
{
  try
  {
    waiting_.reserve(waiting_.size() + at_devices_.size());
  }
  catch (...)
  {
    return end(std::current_exception());
  }
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
  at_devices_.reserve(at_devices_.size() + 1);  // now: a state that is taken and not recorded would be lost
  if (std::none_of(timings_.begin(), timings_.end(), [&](const Timing& timing) { return timing.device == device; }))
    timings_.push_back({device});
  const StateRange taken = takeFrom(waiting_, waiting_count_, most);
  at_devices_.push_back({device, taken, taken.end()});
  return taken;
}

void Batch::noteBrought(std::size_t device, std::size_t states)
{
  for (Timing& timing : timings_)
    if (timing.device == device)
    {
      timing.last = Clock::now();
      if (timing.states == 0)
        timing.first = timing.last;
      timing.states += states;
    }
}

DevicePace Batch::paceOf(std::size_t device) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto seconds = [](Clock::duration time) { return std::chrono::duration<double>(time).count(); };
  for (const Timing& timing : timings_)
    if (timing.device == device)
      return {timing.states, seconds(timing.first - timing.start), seconds(timing.last - timing.start)};
  return {};
}

void Batch::copyForDevice(const StateRange& states, double* to)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_)
      return rows_->zero(states, to);
    ++using_;
  }
  const Finally end_use(
      [this]
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        endUse();
      });
  rows_->copy(states, to);
}

void Batch::endUse()
{
  --using_;
  if (closed_)
    changed_.notify_all();
}

StateRange Batch::beginAnswer(std::size_t device, const StateRange& states)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (closed_)
    return {};
  const auto part = std::find_if(at_devices_.begin(), at_devices_.end(),
                                 [&](const DevicePart& other)
                                 { return other.device == device && other.range.begin == states.begin; });
  if (part == at_devices_.end())
    return {};
  noteBrought(device, states.count);
  const StateRange own{states.begin, std::max(states.begin, std::min(states.end(), part->open_end)) - states.begin};
  part->range = {states.end(), part->range.end() - states.end()};
  if (part->range.begin >= part->open_end)
    at_devices_.erase(part);
  if (own.count != 0)
    ++using_;
  return own;
}

void Batch::endAnswer(const StateRange& states, const std::vector<std::size_t>& undecided)
{
  freeUnlessHit(states, result_.valid);
  std::vector<StateRange> open;
  std::size_t open_count = 0;
  std::size_t by_choice = 0;  // undecided, although devices can check them
  std::exception_ptr error;
  const auto reopen = [&](std::size_t row)
  {
    result_.valid[row] = kNoAnswer;
    result_.colliding[row] = kNoPair;
    ++open_count;
    addRow(row, open);
  };
  try
  {
    for (const std::size_t row : undecided)
      if (rows_->suits(row))
      {
        reopen(row);
        ++by_choice;
      }
    for (const std::size_t row :
         rowsWithout(states.count, [&](std::size_t i) { return rows_->suits(states.begin + i); }))
      reopen(states.begin + row);
  }
  catch (...)
  {
    error = std::current_exception();
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  try
  {
    undecided_.insert(undecided_.end(), open.begin(), open.end());
  }
  catch (...)
  {
    error = std::current_exception();
  }
  if (error)
    end(error);
  undecided_count_ += open_count;
  result_.undecided_states += by_choice;
  answered_ += states.count - open_count;
  answered_by_devices_ += states.count - open_count;
  endUse();
  changed_.notify_all();
}

void Batch::failAnswer(std::exception_ptr error)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  end(std::move(error));
  endUse();
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

std::size_t Batch::waitingCount() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return closed_ ? 0 : waiting_count_;
}

std::size_t Batch::answeredCount() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return answered_;
}

void Batch::close()
{
  std::unique_lock<std::mutex> lock(mutex_);
  closed_ = true;
  changed_.notify_all();
  changed_.wait(lock, [this] { return using_ == 0; });
}

void Batch::end(std::exception_ptr error)
{
  closed_ = true;
  if (!error_)
    error_ = std::move(error);
  changed_.notify_all();
}

void Batch::fail(std::exception_ptr error)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  end(std::move(error));
}

bool Batch::isClosed() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return closed_;
}

BatchResult Batch::takeResult()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (error_)
    std::rethrow_exception(error_);
  const bool is_whole =
      answered_ == count() && std::find(result_.valid.begin(), result_.valid.end(), kNoAnswer) == result_.valid.end();
  if (!is_whole)
    throw std::logic_error("a batch has ended with states that have no answer, or have two");
  result_.device_states = answered_by_devices_;
  return std::move(result_);
}
}  // namespace gpu_planning_scene::core
