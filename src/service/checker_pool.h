#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "service/make_checker.h"

namespace gpu_planning_scene::core
{
/// Keeps checkers for later use, with their trees and their thread. Thread-safe.
class CheckerPool
{
 public:
  explicit CheckerPool(MakeChecker make) : make_(std::move(make)) {}

 private:
  struct Kept
  {
    std::shared_ptr<StateChecker> checker;
    std::shared_ptr<const PlanningScene> scene;  // of the checker
  };

 public:
  /// A checker for one user at a time. The pool must outlive it.
  class Lease
  {
   public:
    /// Takes a kept checker, if possible one that has `scene` already: it also has what it learned there. Otherwise
    /// sets the scene of the one that was used longest ago, or makes a checker. Throws the errors of setScene and of
    /// the function that makes checkers. The scene must not change afterwards. `is_own`: the scene is the service's
    /// own, so a checker that does not take it is an InternalError.
    Lease(CheckerPool& pool, const std::shared_ptr<const PlanningScene>& scene, bool is_own = false);

    /// Keeps the checker for the next user. Without this call it is dropped, because it may be the cause of an error.
    void giveBack();

    const std::shared_ptr<StateChecker>& checker() const { return kept_.checker; }

   private:
    void takeScene(const std::shared_ptr<const PlanningScene>& scene);

    CheckerPool& pool_;
    Kept kept_;
  };

 private:
  const MakeChecker make_;
  std::mutex mutex_;
  std::vector<Kept> idle_;  // guarded by mutex_; in the order of their last use
};
}  // namespace gpu_planning_scene::core
