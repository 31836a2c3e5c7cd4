#pragma once

#include <memory>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
class Scheduler;

/// Checks states on the CPU, without a GL device: traverses bounding volume trees in double precision, on all cores.
/// Thread-safe: calls of check() run side by side. They wait only for a report(), for the first check of a group, and
/// for setScene(), which itself waits until the running checks have ended.
class CpuChecker : public StateChecker
{
 public:
  /// Throws Error if the scene or an option is not valid.
  explicit CpuChecker(std::shared_ptr<const PlanningScene> scene, const CheckerOptions& options = {});
  ~CpuChecker() override;

  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  BatchResult checkBatch(const StateBatch& batch) override;
  SceneReport report(const std::string& group = "") override;
  std::string deviceName() const override;
  bool checksSideBySide() const override { return true; }

 private:
  std::unique_ptr<Scheduler> scheduler_;
};
}  // namespace gpu_planning_scene::core
