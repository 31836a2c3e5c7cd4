#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "collision/batch/batch.h"
#include "collision/batch/batch_device.h"
#include "gpu_planning_scene/batch_checker_options.h"

namespace gpu_planning_scene::core
{
/// A device with a thread of its own, which takes parts of batches. If the device is lost, the parts go back to the
/// batch, and the thread opens the device again; after too many losses in a short time, it does so later. A device that
/// hangs is abandoned together with its threads and all that they use, for good. Own method. Thread-safe.
class DeviceWorker
{
 public:
  using Open = std::function<std::unique_ptr<BatchDevice>()>;

  /// `open` is called on the worker's thread.
  DeviceWorker(Open open, const DeviceLimits& limits);
  /// Calls stop() and waits for the thread, unless it was abandoned or is overdue.
  ~DeviceWorker();
  DeviceWorker(const DeviceWorker&) = delete;
  DeviceWorker& operator=(const DeviceWorker&) = delete;

  /// Asks the thread to destroy the device and to end. Does not wait.
  void stop();

  /// Opens the device, prepares it for the task, and waits for this without a limit. Throws the errors of the device;
  /// then it is not used for some time.
  void open(const DeviceTask& task);

  /// Starts to prepare for a task, and opens the device if it is not open. Does nothing if the worker is not free.
  void prepare(const DeviceTask& task);

  /// Waits until the device has done its work, or is abandoned because it hangs; at most for this time. Returns whether
  /// this has happened.
  bool waitFor(std::chrono::milliseconds time);

  /// Whether the worker could start now: its thread waits, and no rest after losses is due.
  bool isFree() const;

  /// Joins the batch under the number `device`, and begins to take parts: each at most `share` of the waiting states.
  /// The batch must have its DeviceRows. Returns false, and does not join, if the worker is not free.
  bool start(const std::shared_ptr<Batch>& batch, const DeviceTask& task, std::size_t device, double share);

  /// Abandons the device if it works and has not made progress for longer than its limit. Returns whether it did.
  bool abandonIfOverdue();

  std::string name() const;
  /// Whether the device has not been opened yet, or has failed and has not been opened again.
  bool isClosed() const;
  /// Whether the device runs on the cores of the CPU. False until it has been opened.
  bool isSoftware() const;
  std::string fault() const;
  /// `on_cpu`: the device cannot be used now, because of an error.
  DeviceHistory history() const;

 private:
  struct Shared;
  /// Claims the worker, joins the batch, and starts the job. Returns false, and does nothing, if the worker is not
  /// free. `must_rest`: it is not free either during its rest after losses.
  bool begin(std::function<void(Shared&)> job, const DeviceTask& task, const std::shared_ptr<Batch>& batch,
             std::size_t number, bool must_rest);

  std::shared_ptr<Shared> shared_;  // with the thread, which may outlive the worker
};
}  // namespace gpu_planning_scene::core
