#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::python
{
class Interrupt;
class SharedChecker;
using CheckerPtr = std::shared_ptr<SharedChecker>;

/// A checker with its scene. Ctrl-C ends long calls. All functions are
/// called without the interpreter's lock, and are thread-safe: calls are served one after the other.
class SharedChecker
{
 public:
  SharedChecker(std::shared_ptr<core::StateChecker> checker, std::shared_ptr<const core::PlanningScene> scene);

  /// Returns early if the interrupt was requested; the caller then throws its exception.
  core::BatchResult check(const double* states, std::size_t count, const std::string& group, Interrupt& interrupt);
  /// Throws Error for another robot: other threads may have rows of the old one, and so do checkers of motions.
  void setScene(std::shared_ptr<const core::PlanningScene> scene);
  core::SceneReport report(const std::string& group);

  std::shared_ptr<const core::PlanningScene> scene() const;
  std::string deviceName() const { return checker_->deviceName(); }
  std::string deviceWarning() const { return checker_->deviceWarning(); }

  /// Holds the checker, so that the whole of a call is in one scene. The constructor waits for other threads. It throws
  /// Error if this thread holds the checker already: a signal handler has interrupted a call.
  class Call
  {
   public:
    explicit Call(SharedChecker& checker);
    ~Call();
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

    const std::shared_ptr<core::StateChecker>& checker() const { return shared_.checker_; }
    const std::shared_ptr<const core::PlanningScene>& scene() const { return shared_.scene_; }

   private:
    SharedChecker& shared_;
    std::unique_lock<std::mutex> lock_;
  };

 private:
  std::shared_ptr<core::StateChecker> checker_;
  mutable std::mutex scene_mutex_;  // held only for a moment
  std::shared_ptr<const core::PlanningScene> scene_;
  std::mutex mutex_;                                        // held by a Call
  std::atomic<std::thread::id> caller_{std::thread::id()};  // the thread that holds it
  std::string known_warning_;                               // of the device; guarded by mutex_
};
}  // namespace gpu_planning_scene::python
