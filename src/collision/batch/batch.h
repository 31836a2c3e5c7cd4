#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "collision/batch/device_rows.h"
#include "collision/bounds/displacement_bounds.h"
#include "collision/problem/state_range.h"
#include "gpu_planning_scene/batch_checker_options.h"

namespace gpu_planning_scene::core
{
/// The work of a device in a batch, and its time.
struct DevicePace
{
  std::size_t states = 0;      ///< that it has brought
  double first_seconds = 0.0;  ///< from its first request for states to its first answer
  double seconds = 0.0;        ///< from its first request to its last answer
};

/// A batch of valid states while cores and devices check it. It is cut here, and only here: each worker takes a part
/// when it is free. The parts of cores are small and those of devices large. All parts become smaller towards the end,
/// so that all workers end at about the same time. Each state is answered once, whoever takes it. A state without an
/// answer is never free. Thread-safe.
///
/// A part whose device is lost goes back. If no state waits, free cores overtake devices: they take states of the parts
/// that devices still work on, from the end of a part, and the device's answers for these states are dropped. So nobody
/// waits for a device that hangs. If the memory does not suffice, the batch fails.
///
/// Guided self-scheduling: C. Polychronopoulos, D. Kuck (1987).
class Batch
{
 public:
  /// `cores`: their number.
  Batch(std::size_t count, std::optional<Margins> margins, std::size_t cores);

  std::size_t count() const { return count_; }
  const Margins* margins() const { return margins_ ? &*margins_ : nullptr; }
  /// Workers write 0 for each state of their parts that collides, and its pair.
  BatchResult& result() { return result_; }

  // For cores.
  /// Whether cores take the states that devices can check. At first, they do.
  void letCoresHelp(bool help);
  /// Replaces `part` by the next part: ranges of at most `most` states together. None: there is none now, but a device
  /// may leave more states undecided.
  void takeForCore(std::size_t most, std::vector<StateRange>& part);
  /// The core has checked these states.
  void answered(const std::vector<StateRange>& part);
  /// Waits until there may be a part for a core, or until the batch has ended; at most until `time`.
  void waitForCores(std::chrono::steady_clock::time_point time);
  /// The number of states that cores can take now.
  std::size_t availableForCores() const;

  // For devices, which have numbers.
  /// Must be called before a device joins, once. What the rows refer to must live until the batch is closed.
  void setDeviceRows(std::unique_ptr<const DeviceRows> rows) { rows_ = std::move(rows); }
  /// Copies states of a part for a device, see DeviceRows; zeros if the batch is closed: the states may be gone then.
  void copyForDevice(const StateRange& states, double* to);
  /// No part goes to a device that has not joined, or has left.
  void join(std::size_t device);
  bool hasJoined(std::size_t device) const;
  /// Its parts go back, because it was lost.
  void giveBack(std::size_t device);
  /// Its parts go back. If no device is left, cores take all states.
  void leave(std::size_t device);
  /// The next part: at most `most` states, and at most `share` of the waiting states. An empty part: there is none.
  StateRange takeForDevice(std::size_t device, std::size_t most, double share);
  /// Must be called before a device writes answers. `states`: the first states of a part that it has not answered yet.
  /// Returns those that it may write, because no core has taken them; if there is one, endAnswer must follow.
  StateRange beginAnswer(std::size_t device, const StateRange& states);
  /// The states of beginAnswer are answered, except for `undecided` ones and those that only cores can check. Cores
  /// then check these.
  void endAnswer(const StateRange& states, const std::vector<std::size_t>& undecided);
  /// The states of beginAnswer have no answers, because of an error. The batch fails.
  void failAnswer(std::exception_ptr error);
  void add(const GpuWork& work);
  /// The work of all devices.
  GpuWork work() const;

  /// The number of states that no worker has taken.
  std::size_t waitingCount() const;
  std::size_t answeredCount() const;
  /// The work and the time of the device up to now.
  DevicePace paceOf(std::size_t device) const;
  bool isComplete() const { return answeredCount() == count(); }
  /// Ends the batch: no further part is taken, and no device reads states or writes answers. Waits for devices that do.
  void close();
  /// Closes the batch because of an error. The first error counts.
  void fail(std::exception_ptr error);
  bool isClosed() const;
  /// The result of a closed batch. Throws the error of fail, or std::logic_error if a state has no answer.
  BatchResult takeResult();

 private:
  using Clock = std::chrono::steady_clock;

  /// A part that a device works on. Cores have taken the states from `open_end` on.
  struct DevicePart
  {
    std::size_t device;
    StateRange range;
    std::size_t open_end;
  };
  struct Timing
  {
    std::size_t device;
    std::size_t states = 0;
    Clock::time_point start = Clock::now();
    Clock::time_point first = start;
    Clock::time_point last = start;
  };

  // The caller of these functions holds mutex_.
  std::size_t available() const;
  StateRange takeNext(std::size_t most);
  StateRange overtake(std::size_t most);
  void returnParts(std::size_t device);
  void end(std::exception_ptr error);
  void endUse();
  void noteBrought(std::size_t device, std::size_t states);

  const std::size_t count_;
  const std::optional<Margins> margins_;
  const std::size_t cores_;
  std::unique_ptr<const DeviceRows> rows_;
  BatchResult result_;

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::vector<StateRange> waiting_;  // for anybody; the next one last
  std::size_t waiting_count_;        // states of waiting_
  std::vector<StateRange> undecided_;
  std::size_t undecided_count_ = 0;  // states of undecided_
  std::vector<DevicePart> at_devices_;
  std::vector<std::size_t> joined_;
  std::vector<Timing> timings_;
  std::size_t answered_ = 0;
  std::size_t answered_by_devices_ = 0;
  std::size_t using_ = 0;  // threads of devices that read states, and devices between beginAnswer and endAnswer
  bool cores_help_ = true;
  bool closed_ = false;
  std::exception_ptr error_;
  GpuWork work_;
};
}  // namespace gpu_planning_scene::core
