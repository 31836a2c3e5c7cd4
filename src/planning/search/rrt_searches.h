#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include <ompl/base/Planner.h>

#include "base/turn.h"
#include "planning/search/rrt_search.h"

namespace gpu_planning_scene::core
{
/// Searches for the same problem that differ in their random states. They run side by side, each on its own thread, and
/// the first solution ends them all. The time of a search depends much on its random states, so the fastest of several
/// searches takes far less time than most of them. Not thread-safe.
///
/// I. Aguinaga, D. Borro, L. Matey: Parallel RRT-based path planning for selective disassembly planning. International
/// Journal of Advanced Manufacturing Technology 36, 2008 ("OR parallel RRT").
class RrtSearches
{
 public:
  struct Options
  {
    std::size_t count;       ///< largest number of searches, at least 1
    std::size_t max_rounds;  ///< of the first search; 0: no limit
    BidirectionalTree::Limits limits;
    std::vector<ompl::geometric::PathGeometric> known_paths = {};  ///< tried once, after the first round
  };

  explicit RrtSearches(const ompl::base::Planner& planner);

  /// The first search. Roots are added to it.
  RrtSearch& first() { return *searches_.front(); }

  /// Runs rounds until a search has a solution, `ptc` returns true or the rounds have ended. Returns the solution, or
  /// null. `before_round` is called before each round of the first search, which runs on the calling thread. The other
  /// searches begin after a few rounds of it, with its roots of that time; later roots are those of the first search
  /// alone. They call isSatisfied() and isStartGoalPairValid() of the goal. An exception of a search ends them all, and
  /// is thrown again here.
  RrtSearch::Path run(const MotionValidator& validator, const ompl::base::GoalSampleableRegion& goal,
                      const Options& options, const std::function<void()>& before_round,
                      const ompl::base::PlannerTerminationCondition& ptc);

  /// See RrtSearch: over all searches.
  RrtSearch::Path provenPath(const MotionValidator& validator, const ompl::base::PlannerTerminationCondition& ptc);
  /// The path of RrtSearch::approximatePath in the search that came closest to the goal.
  RrtSearch::Path approximatePath(const MotionValidator& validator, const ompl::base::PlannerTerminationCondition& ptc);

  /// Adds the trees of the search with the last path, or of the first search.
  void addTo(ompl::base::PlannerData& data) const { searches_[solver_]->addTo(data); }

 private:
  void addSearches(std::size_t count);

  const ompl::base::Planner& planner_;
  Turn proofs_;  // one path is proven at a time
  std::vector<std::unique_ptr<RrtSearch>> searches_;
  std::size_t solver_ = 0;  // index of the search that found the last path
};
}  // namespace gpu_planning_scene::core
