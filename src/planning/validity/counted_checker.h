#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Forwards all calls to another checker, and counts the checked states and the time. Thread-safe if that checker is.
class CountedChecker : public StateChecker
{
 public:
  explicit CountedChecker(std::shared_ptr<StateChecker> checker) : checker_(std::move(checker)) {}

  void setScene(std::shared_ptr<const PlanningScene> scene) override { checker_->setScene(std::move(scene)); }
  BatchResult checkBatch(const StateBatch& batch) override
  {
    BatchResult result = checker_->checkBatch(batch);
    states_ += batch.count;
    microseconds_ += static_cast<std::uint64_t>(1e6 * result.seconds);
    return result;
  }
  SceneReport report(const std::string& group) override { return checker_->report(group); }
  std::string deviceName() const override { return checker_->deviceName(); }
  std::string deviceWarning() const override { return checker_->deviceWarning(); }
  bool checksSideBySide() const override { return checker_->checksSideBySide(); }

  std::uint64_t states() const { return states_; }
  double seconds() const { return 1e-6 * static_cast<double>(microseconds_); }

 private:
  std::shared_ptr<StateChecker> checker_;
  std::atomic<std::uint64_t> states_{0};
  std::atomic<std::uint64_t> microseconds_{0};
};
}  // namespace gpu_planning_scene::core
