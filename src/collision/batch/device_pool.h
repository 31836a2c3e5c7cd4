#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "collision/batch/batch.h"
#include "collision/batch/device_worker.h"
#include "collision/proofs/robot_proofs.h"

namespace gpu_planning_scene::core
{
/// The devices of a checker. A device joins a batch if the cores alone would need clearly longer than the device needs
/// for its first answer, as far as the last batches of the same group show. Thread-safe.
class DevicePool
{
 public:
  /// `device_only`: see BatchCheckerOptions.
  DevicePool(std::vector<std::unique_ptr<DeviceWorker>> devices, bool device_only);
  ~DevicePool();

  bool isEmpty() const { return devices_.empty(); }
  /// Whether cores check only what devices cannot: because this was asked for, or because a device is a software
  /// renderer, which runs on the cores itself.
  bool isDeviceOnly() const;

  /// Opens all devices, and waits for them. Throws the first error if a device cannot be opened; with `one_suffices`
  /// only if none can be.
  void open(const DeviceTask& task, bool one_suffices);
  /// See DeviceWorker.
  void prepare(const DeviceTask& task);

  /// Waits until each device has done its work, or is abandoned; at most for this time. Returns whether this has
  /// happened.
  bool waitFor(std::chrono::milliseconds time);
  void abandonOverdue();

  /// Whether `join` would do anything for a batch of the group with this many waiting states.
  bool suits(const std::string& group, std::size_t waiting) const;
  /// Lets devices join the batch, and opens devices again that have failed. Returns whether any has joined.
  bool join(const std::shared_ptr<Batch>& batch, const DeviceTask& task, const std::string& group);

  /// Learns the pace from a batch that has ended. `core_seconds`: how long the cores worked on it; 0: not known.
  void learn(const Batch& batch, const std::string& group, std::size_t core_states, double core_seconds);
  /// Forgets the paces of the group if these proofs are better than those with which they were measured.
  void noteProofs(const std::string& group, ProofStage stage);
  /// The next scenes have another robot.
  void forgetPaces();

  /// Whether no device can be used now, because of errors.
  bool isUnusable() const;
  std::string name() const;
  std::string warning() const;
  DeviceHistory history() const;

 private:
  struct DeviceMean
  {
    std::size_t batches = 0;
    double rate = 0.0;     // states per second; 0: not known
    double latency = 0.0;  // seconds from the first request to the first answer
  };
  struct Paces
  {
    ProofStage proofs = ProofStage::None;
    double cores = 0.0;  // states per second of all cores; 0: not known
    std::vector<DeviceMean> devices;
  };

  Paces pacesOf(const std::string& group) const;
  bool pays(const DeviceMean& device, double cores, std::size_t waiting) const;

  const bool device_only_;
  const std::vector<std::unique_ptr<DeviceWorker>> devices_;
  mutable std::mutex mutex_;  // guards the member below
  std::map<std::string, Paces> paces_;
};
}  // namespace gpu_planning_scene::core
