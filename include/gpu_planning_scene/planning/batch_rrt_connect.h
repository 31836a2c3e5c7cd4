#pragma once

#include <cstddef>
#include <memory>

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>

namespace gpu_planning_scene::core
{
class RrtSearch;

/// RRT-Connect for a MotionValidator, which checks many motions in little more time than one: a tree from the start
/// states and one from the goal states grow in rounds, and the motions of a round are checked in one call.
///  - At first, the straight ways between start and goal states.
///  - Then the trees take turns: one grows by motions towards many random states. In the next round, the other tree
///    heads for each of the vertices that this gave, in pieces no longer than the range, as far as they are valid,
///    while it grows random branches of its own.
/// Where the trees meet in several places at once, the shortest path is the solution. The trees grow by motions whose
/// samples are free; where the validator asks for more (MotionRule::Bound), the motions of a path are proven once there
/// is one, and what is not proven is taken out of the trees, with all that has grown from it.
///
/// J. J. Kuffner, S. M. LaValle: RRT-Connect: An efficient approach to single-query path planning. ICRA 2000.
/// On growing many branches of a tree at once, there by threads: J. Ichnowski, R. Alterovitz: Parallel sampling-based
/// motion planning with superlinear speedup. IROS 2012.
class BatchRrtConnect : public ompl::base::Planner
{
 public:
  explicit BatchRrtConnect(const ompl::base::SpaceInformationPtr& information);
  ~BatchRrtConnect() override;

  /// The longest motion that is added to a tree; 0 or less: setup() chooses one, 4 % of the space's extent.
  void setRange(double range);
  double getRange() const { return range_; }

  /// How many random branches a round has at most, at least 1. While the trees are small it has fewer.
  void setBranches(unsigned int branches);
  unsigned int getBranches() const { return branches_; }

  /// Throws ompl::Exception if the space information has no gpu_planning_scene::core::MotionValidator.
  void setup() override;
  void clear() override;
  /// Called again, it goes on with the trees that there are. The termination condition is asked between batches of
  /// states. Once it holds, there is some time more, whatever it says, to prove a solution that there was no time for:
  /// a tenth of what was spent, from 0.1 s to 1 s; and if there is none, as much to prove the way to what is closest.
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;
  void getPlannerData(ompl::base::PlannerData& data) const override;

 private:
  const ompl::base::State* firstGoal(const ompl::base::GoalSampleableRegion& goal,
                                     const ompl::base::PlannerTerminationCondition& ptc);
  ompl::base::PlannerStatus takeInputs(const ompl::base::GoalSampleableRegion& goal,
                                       const ompl::base::PlannerTerminationCondition& ptc);
  void takeMoreGoals();

  double range_ = 0.0;
  unsigned int branches_ = 64;
  std::unique_ptr<RrtSearch> search_;  // what clear() forgets
};
}  // namespace gpu_planning_scene::core
