#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "node/markers/shown_plan.h"

namespace gpu_planning_scene::core
{
/// The newest plan that its publisher has not taken yet. So the thread of a request does not wait for the publisher.
/// Thread-safe.
class NewestPlan
{
 public:
  void put(std::shared_ptr<const ShownPlan> plan)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    plan_ = std::move(plan);
  }

  /// Null: there is no plan since the last call.
  std::shared_ptr<const ShownPlan> take()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::move(plan_);
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const ShownPlan> plan_;
};
}  // namespace gpu_planning_scene::core
