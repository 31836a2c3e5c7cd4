#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <vector>

#include <ompl/base/PlannerTerminationCondition.h>

#include "base/helper_thread.h"
#include "planning/search/rrt_search.h"

namespace gpu_planning_scene::core
{
/// The threads of the searches that run beside the first one. They end when one of them has a path, when one of them
/// throws, and with this object. One caller at a time.
class OtherSearches
{
 public:
  /// Runs a round of the search with this number. It is called from several threads, for each search from one.
  using Round = std::function<RrtSearch::Path(std::size_t search, const ompl::base::PlannerTerminationCondition& end)>;

  OtherSearches() : end_([this] { return has_ended_.load(); }) {}
  ~OtherSearches() { end(); }
  OtherSearches(const OtherSearches&) = delete;
  OtherSearches& operator=(const OtherSearches&) = delete;

  /// Starts the searches 1 to `count` - 1. If the system cannot start more threads, the started ones do the work.
  void start(std::size_t count, const Round& round);

  /// Returns true when the searches are to end or have ended.
  const ompl::base::PlannerTerminationCondition& hasEnded() const { return end_; }

  /// Ends the searches and waits for them.
  void end();

  struct Solution
  {
    std::size_t search = 0;
    RrtSearch::Path path = nullptr;  ///< null: no search has one
  };
  /// The solution of the first search in order that has one. Throws again what a search threw. Call it after end().
  Solution solution() const;

 private:
  std::atomic<bool> has_ended_{false};
  ompl::base::PlannerTerminationCondition end_;
  std::vector<RrtSearch::Path> paths_;      // by search
  std::vector<std::exception_ptr> errors_;  // by search
  std::list<HelperThread> threads_;
};
}  // namespace gpu_planning_scene::core
