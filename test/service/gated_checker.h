#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Records the checks of several GatedCheckers. While the gate is closed, each check waits at it.
class Gate
{
 public:
  void close();
  void open();
  /// Waits until `checks` checks in total have reached the gate.
  void waitForChecks(std::size_t checks);
  std::vector<std::size_t> batches() const;  ///< number of states of each check, in order
  std::size_t checkers() const;

 private:
  friend class GatedChecker;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = true;
  std::size_t checkers_ = 0;
  std::vector<std::size_t> batches_;
};

/// A checker with known answers: a state is free if its first variable is at least 0 and the scene's revision is even.
/// A first variable of 13 is an error. A scene named "unusable" is an error.
class GatedChecker : public StateChecker
{
 public:
  GatedChecker(std::shared_ptr<const PlanningScene> scene, Gate& gate);

  void setScene(std::shared_ptr<const PlanningScene> scene) override;
  /// In slices of 24 states.
  BatchResult checkBatch(const StateBatch& batch) override;
  SceneReport report(const std::string& group) override;
  std::string deviceName() const override { return "gate"; }

 private:
  BatchResult checkSlice(const double* states, std::size_t count, const std::string& group);

  Gate& gate_;
  std::shared_ptr<const PlanningScene> scene_;
};
}  // namespace gpu_planning_scene::core
