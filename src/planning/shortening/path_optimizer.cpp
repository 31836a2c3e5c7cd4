#include "gpu_planning_scene/planning/path_optimizer.h"

#include <utility>

#include <ompl/base/goals/GoalState.h>
#include <ompl/base/goals/GoalStates.h>

#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/path_shortcutter.h"
#include "planning/validity/bulk_validator.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;

// Between two turns of shortcuts, a search runs for so many rounds.
constexpr unsigned int kRoundsOfSearch = 16;

constexpr double kRounding = 1e-12;  // of a path's length: exceeds the rounding of its sum

bool hasOneGoal(const ob::Goal& goal)
{
  const auto* states = dynamic_cast<const ob::GoalStates*>(&goal);
  return goal.getType() == ob::GOAL_STATE || (states && states->getStateCount() == 1);
}

/// Searches for a path that is shorter than a given one.
class Search
{
 public:
  Search(const ob::SpaceInformationPtr& information, const ob::State* start, const ob::GoalPtr& goal)
    : definition_(std::make_shared<ob::ProblemDefinition>(information)), planner_(information)
  {
    definition_->addStartState(start);
    definition_->setGoal(goal);
    planner_.setProblemDefinition(definition_);
    planner_.setup();
    planner_.setMaxRounds(kRoundsOfSearch);
    planner_.setExactOnly(true);
    planner_.setSearches(1);  // the rounds are too few for threads
  }

  /// Goes on searching. Returns a path or null.
  std::shared_ptr<PathGeometric> next(double length, const ob::PlannerTerminationCondition& ptc)
  {
    planner_.setLargestLength(length);
    if (planner_.solve(ptc) != ob::PlannerStatus::EXACT_SOLUTION)
      return nullptr;
    auto path = std::dynamic_pointer_cast<PathGeometric>(definition_->getSolutionPath());
    definition_->clearSolutionPaths();
    planner_.clear();
    return path;
  }

 private:
  ob::ProblemDefinitionPtr definition_;
  BatchRrtConnect planner_;
};
}  // namespace

PathOptimizer::PathOptimizer(const ob::SpaceInformationPtr& information, ob::GoalPtr goal)
  : information_(information), goal_(std::move(goal))
{
  bulkValidatorOf(*information, "PathOptimizer");
}

void PathOptimizer::improve(PathGeometric& path, const ob::PlannerTerminationCondition& ptc, const Found& found)
{
  PathShortcutter shortcutter(information_);
  Search search(information_, path.getState(0), goal_);
  double length = path.length();
  const auto take_shortened = [&](PathGeometric candidate)
  {
    shortcutter.shorten(candidate, ptc);
    const bool has_fewer_states =
        candidate.getStateCount() < path.getStateCount() && candidate.length() <= (1.0 + kRounding) * length;
    if (candidate.length() >= length && !has_fewer_states)
      return;
    path = candidate;
    length = path.length();
    if (found)
      found(path);
  };
  take_shortened(path);
  while (!ptc && !(path.getStateCount() == 2 && hasOneGoal(*goal_)))
  {
    if (const auto other = search.next(length, ptc))
      take_shortened(*other);
    take_shortened(path);
  }
}
}  // namespace gpu_planning_scene::core
