#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/known_paths.h"

namespace gpu_planning_scene::core
{
class MotionValidator;
class RrtSearches;

/// RRT-Connect for a MotionValidator, which checks many motions in little more time than one motion. Two trees, from
/// the start states and from the goal states, grow in rounds. All motions of a round are checked in one call.
///   - The first round checks the straight motions between start and goal states.
///   - Then one tree grows motions towards many random states: the smaller one, and now and then the larger one. In the
///     next round, the other tree grows towards each of the new vertices, in segments no longer than the range and as
///     far as they are valid. Three of four branches grow towards states whose revolute joints are within half a
///     turn of the straight line between a start and a goal, the others, and all within a largest length, towards any.
/// After the first round, known paths are tried, if there are any (setKnownPaths): the free motions of the two that
/// begin and end nearest to the problem's states become branches.
/// If the trees meet in several places at once, the shortest path is the solution.
/// The trees grow by motions that MotionValidator::validateExtensions accepts. When a path is found, its motions are
/// validated by the validator's rule. A motion that fails is removed from its tree, with everything that grew from it.
/// If the checks of the validator run side by side (StateChecker::checksSideBySide), a hard problem gets several
/// searches with different random states by default, each on a thread of its own. While one proves its path, the others
/// wait. The first solution ends them all. Then isSatisfied() and isStartGoalPairValid() of the goal are called from
/// several threads, also while goals are sampled. Goals that arrive late reach only one of the searches. Not
/// thread-safe.
///
/// J. J. Kuffner, S. M. LaValle: RRT-Connect: An efficient approach to single-query path planning. ICRA 2000.
/// Balanced trees: S. M. LaValle: Planning Algorithms. Cambridge University Press, 2006, section 5.5.3.
/// Many branches at once (with threads, in the paper): J. Ichnowski, R. Alterovitz: Parallel sampling-based motion
/// planning with superlinear speedup. IROS 2012.
/// Several searches, of which the first solution counts: I. Aguinaga, D. Borro, L. Matey: Parallel RRT-based path
/// planning for selective disassembly planning. International Journal of Advanced Manufacturing Technology 36, 2008.
class BatchRrtConnect : public ompl::base::Planner, public TriesKnownPaths
{
 public:
  explicit BatchRrtConnect(const ompl::base::SpaceInformationPtr& information);
  ~BatchRrtConnect() override;

  /// The longest motion that is added to a tree, in the distance of the space. With 0 or less, setup() chooses 4 % of
  /// the extent of the space, or 1 % if the validator has path constraints.
  void setRange(double range);
  double getRange() const { return range_; }

  /// The largest number of random branches in a round, at least 1. While the trees are small, a round has fewer, but at
  /// least 8 of them.
  void setBranches(unsigned int branches);
  unsigned int getBranches() const { return branches_; }

  /// The largest number of searches; 0: the default, one for each core and at most 8. With more than one, the solution
  /// depends on which search is the fastest, so equal seeds do not give equal paths. Throws ompl::Exception for more
  /// than 64.
  void setSearches(unsigned int searches);
  unsigned int getSearches() const { return searches_; }

  /// solve() gives up after this many rounds of the first search, whatever time they take; 0: only the time limits the
  /// search. If only the rounds limit it, a single search (setSearches) that fails gives the same result again with the
  /// same seed, unless the time for its last proofs ends (see solve()).
  void setMaxRounds(unsigned int rounds) { max_rounds_ = rounds; }
  unsigned int getMaxRounds() const { return max_rounds_; }

  /// True: solve() returns a path to a goal or none, and takes no time after `ptc` has returned true or the rounds have
  /// ended. By default, it may also return a path that ends near a goal.
  void setExactOnly(bool is_exact_only) { is_exact_only_ = is_exact_only; }

  /// Random states are drawn among those through which a path from a start to a goal can be shorter than this; by
  /// default, they are not limited.
  void setLargestLength(double length) { largest_length_ = length; }

  void setKnownPaths(std::vector<ompl::geometric::PathGeometric> paths) override { known_paths_ = std::move(paths); }

  /// Throws ompl::Exception if the space information has no gpu_planning_scene::core::MotionValidator.
  void setup() override;
  void clear() override;
  /// Grows the trees until there is a solution or `ptc` returns true; a second call continues with the same trees, in
  /// the same scene.
  /// `ptc` is tested between batches of states. If the planner has found a solution when `ptc` returns true, but has
  /// not proven it, it takes more time for the proof: a tenth of the time so far, but at least 0.1 s and at most 1 s.
  /// If no solution is proven, the planner takes the same time again to prove the path to the vertex closest to the
  /// goal.
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;
  /// The motions of the trees, which are checked coarsely unless a path has led along them.
  void getPlannerData(ompl::base::PlannerData& data) const override;

 private:
  const ompl::base::State* firstGoal(const ompl::base::GoalSampleableRegion& goal,
                                     const ompl::base::PlannerTerminationCondition& ptc);
  ompl::base::PlannerStatus takeInputs(const ompl::base::GoalSampleableRegion& goal,
                                       const ompl::base::PlannerTerminationCondition& ptc);
  void takeMoreGoals();

  std::size_t searchesOf(const MotionValidator& validator) const;

  double range_ = 0.0;
  unsigned int branches_ = 64;
  unsigned int max_rounds_ = 0;
  bool is_exact_only_ = false;
  double largest_length_ = std::numeric_limits<double>::infinity();
  unsigned int searches_ = 0;
  std::vector<ompl::geometric::PathGeometric> known_paths_;
  std::unique_ptr<RrtSearches> search_;  // everything that clear() deletes
};
}  // namespace gpu_planning_scene::core
