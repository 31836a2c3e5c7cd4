#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "collision/batch/change_gate.h"
#include "collision/batch/device_worker.h"
#include "collision/checkers/cpu_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Checks batches of states with the cores of the CPU and with devices, which work together on each large batch. A core
/// checks a small batch on the caller's thread. A device that runs on the cores itself (a software renderer) works
/// instead of them, if it is faster. If no device is usable, the cores check all states; the answers are the same.
/// Thread-safe: checks run side by side. A device works on one batch at a time.
class Scheduler
{
 public:
  /// Without devices, the cores check all states. `device_only`: see BatchCheckerOptions.
  Scheduler(const CheckerOptions& options, std::vector<std::unique_ptr<DeviceWorker>> devices, bool device_only);

  /// Throws Error and keeps the old scene if this one cannot be used. The devices get the scene in the background, and
  /// are opened if they are not open.
  void setScene(std::shared_ptr<const PlanningScene> scene);

  /// Sets the first scene, waits until all devices have it, and throws their errors.
  void openDevices(std::shared_ptr<const PlanningScene> scene);

  /// See StateChecker.
  BatchResult check(const StateBatch& asked);
  SceneReport report(const std::string& group);
  std::string deviceName() const;
  std::string deviceWarning() const;

  DeviceHistory history() const;
  /// The work of the devices for the last batch.
  GpuWork lastWork() const;

 private:
  /// A device that takes part in a batch.
  struct Invitation
  {
    std::size_t device;
    double share;        // of the waiting states, for each part
    std::size_t most;    // states of a part
    std::size_t rounds;  // parts; 0: no limit
  };
  struct Plan
  {
    std::vector<Invitation> devices;
    bool cores_help = true;
  };

  Plan plan(std::size_t count) const;
  void setOnCpu(std::shared_ptr<const PlanningScene> scene);
  DeviceTask taskOf(const std::string& group);
  std::vector<std::size_t> onlyForCores(const StateBatch& asked, const Margins* margins);
  BatchResult checkOnCaller(const StateBatch& asked, const Margins* margins);
  BatchResult checkTogether(const StateBatch& borrowed, std::optional<Margins> margins, const Plan& plan);
  void runCores(Batch& batch, const StateBatch& asked);
  void noteCores(std::size_t states, double seconds);
  void noteProofs(ProofStage stage);
  void noteWork(const GpuWork& work);

  ChangeGate gate_;  // checks share it; setScene holds it alone
  CpuScene scene_;
  const bool device_only_;
  std::vector<std::unique_ptr<DeviceWorker>> devices_;
  std::mutex turn_;                      // with device_only, batches wait for the devices
  std::atomic<double> cores_rate_{0.0};  // states per second of all cores; 0: not known
  std::atomic<std::uint64_t> batches_on_cpu_{0};
  mutable std::mutex work_mutex_;
  GpuWork last_work_;                           // guarded by work_mutex_
  ProofStage known_proofs_ = ProofStage::None;  // likewise; the rates were measured with these
};
}  // namespace gpu_planning_scene::core
