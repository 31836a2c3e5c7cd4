#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::python
{
class Interrupt;
class SharedChecker;
using CheckerPtr = std::shared_ptr<SharedChecker>;

/// A checker with its scene. It splits long calls into parts, between which Ctrl-C can end the call. All functions are
/// called without the interpreter's lock, and are thread-safe: calls are served one after the other.
class SharedChecker
{
 public:
  SharedChecker(std::shared_ptr<core::StateChecker> checker, std::shared_ptr<const core::PlanningScene> scene);

  /// Returns early if the interrupt was requested; the caller then throws its exception.
  core::BatchResult check(const double* states, std::size_t count, const std::string& group, Interrupt& interrupt);
  /// Throws Error for a robot with another number of variables: other threads may have rows of the old width.
  void setScene(std::shared_ptr<const core::PlanningScene> scene);
  core::SceneReport report(const std::string& group);

  const std::shared_ptr<core::StateChecker>& checker() const { return checker_; }
  std::shared_ptr<const core::PlanningScene> scene() const;

 private:
  std::size_t statesOfPart() const;

  std::shared_ptr<core::StateChecker> checker_;
  mutable std::mutex scene_mutex_;  // held only for a moment
  std::shared_ptr<const core::PlanningScene> scene_;
  std::mutex mutex_;                // held during a call, so that a call checks one scene
  double seconds_per_state_ = 0.0;  // of the last part; 0: not measured
};
}  // namespace gpu_planning_scene::python
