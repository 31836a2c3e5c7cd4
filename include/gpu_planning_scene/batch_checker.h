#pragma once

#include <memory>
#include <string>

#include "gpu_planning_scene/batch_checker_options.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
class Scheduler;

/// Checks batches of states with devices and with the cores of the CPU. They work together on a large batch: each takes
/// a part of it when it is free. Small batches are checked on the caller's thread. On a
/// device: forward kinematics, proofs, tests of bounding volumes, tree traversal, triangle tests. Float arithmetic
/// leaves few states undecided. The CPU decides these with its own trees, in double precision.
///
/// A device that is lost is opened again; if it cannot be used, the CPU checks all states, with the same answers (see
/// DeviceLimits). Thread-safe: calls of check() run side by side; a device works for one of them at a time.
///
/// A. Gress, G. Zachmann: Object-Space Interference Detection on Programmable Graphics Hardware (2003).
class BatchChecker : public StateChecker
{
 public:
  /// Throws Error if no EGL device can be used (the message lists the devices that were tried), if a shader does not
  /// compile (the message has its log), or if the scene or an option is not valid.
  explicit BatchChecker(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options = {});
  /// For code inside the package. The scene is set by setScene().
  explicit BatchChecker(std::unique_ptr<Scheduler> scheduler);
  ~BatchChecker() override;

  /// The devices take the scene over in the background. If a device cannot hold it, the CPU checks all states.
  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  BatchResult checkBatch(const StateBatch& batch) override;
  SceneReport report(const std::string& group = "") override;
  bool checksSideBySide() const override { return true; }

  /// The devices that are used now, or "CPU".
  std::string deviceName() const override;
  /// Names also the devices that have failed.
  std::string deviceWarning() const override;
  DeviceHistory history() const;
  /// The work of the devices for the last call of `check`. They count it in any case, so this call costs nothing.
  GpuWork lastWork() const;

 private:
  std::unique_ptr<Scheduler> scheduler_;
};
}  // namespace gpu_planning_scene::core
