#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/turn.h"
#include "collision/batch/change_gate.h"
#include "collision/batch/device_pool.h"
#include "collision/cpu/cpu_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Checks batches of states with the cores of the CPU and with devices, which work together on each large batch. Small
/// batches are checked on the caller's thread. If no device is usable, the cores check all states; the answers are the
/// same. Thread-safe: checks run side by side. A device works on one batch at a time.
class Scheduler
{
 public:
  /// Without devices, the cores check all states. `device_only`: see BatchCheckerOptions.
  Scheduler(const CheckerOptions& options, std::vector<std::unique_ptr<DeviceWorker>> devices, bool device_only);

  /// Throws Error and keeps the old scene if this one cannot be used. The devices get the scene in the background, and
  /// are opened if they are not open.
  void setScene(std::shared_ptr<const PlanningScene> scene);

  /// Sets the first scene, and waits until all devices have it. Throws the first error if a device cannot be opened;
  /// with `one_suffices` only if none can be.
  void openDevices(std::shared_ptr<const PlanningScene> scene, bool one_suffices);

  /// See StateChecker.
  BatchResult check(const StateBatch& asked);
  SceneReport report(const std::string& group);
  std::string deviceName() const { return devices_.name(); }
  std::string deviceWarning() const { return devices_.warning(); }

  DeviceHistory history() const;
  /// The work of the devices for the last batch.
  GpuWork lastWork() const;

 private:
  class DeviceJoin;
  class Progress;

  void setOnCpu(std::shared_ptr<const PlanningScene> scene);
  DeviceTask taskOf(const std::string& group);
  std::optional<Margins> marginsOf(const StateBatch& asked);
  BatchResult checkOnCaller(const StateBatch& asked);
  BatchResult checkTogether(const StateBatch& asked);
  void runCores(Batch& batch, const StateBatch& asked, DeviceJoin& devices, Progress& progress);
  void noteWork(const GpuWork& work);

  ChangeGate gate_;  // checks share it; setScene holds it alone
  CpuScene scene_;
  DevicePool devices_;
  Turn turn_;  // with device_only, batches wait for the devices
  std::atomic<std::uint64_t> batches_on_cpu_{0};
  mutable std::mutex work_mutex_;
  GpuWork last_work_;  // guarded by work_mutex_
};
}  // namespace gpu_planning_scene::core
