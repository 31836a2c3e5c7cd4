#pragma once

#include <functional>

#include <ompl/base/Goal.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>

namespace gpu_planning_scene::core
{
/// Shortens a path for as long as the time allows. Shortcuts bring a path near the shortest one of its kind, which
/// passes the obstacles on the same sides. Further searches with BatchRrtConnect find paths of other kinds. They draw
/// only states through which a path can be shorter than the best one. Not thread-safe.
///
/// Restarts that are shortened: R. Luna, I. A. Sucan, M. Moll, L. E. Kavraki: Anytime solution optimization for
/// sampling-based motion planning. ICRA 2013. The states that can improve a path: J. D. Gammell, S. S. Srinivasa, T. D.
/// Barfoot: Informed RRT*. IROS 2014.
class PathOptimizer
{
 public:
  /// Receives each path that is shorter than those before, or as long with fewer states.
  using Found = std::function<void(const ompl::geometric::PathGeometric&)>;

  /// Throws ompl::Exception if the space information has no gpu_planning_scene::core::MotionValidator. `goal`: where
  /// paths may end.
  PathOptimizer(const ompl::base::SpaceInformationPtr& information, ompl::base::GoalPtr goal);

  /// Returns when `ptc` returns true, or when the path is the straight motion to the only goal state. The path must be
  /// valid. Its first state stays the same.
  void improve(ompl::geometric::PathGeometric& path, const ompl::base::PlannerTerminationCondition& ptc,
               const Found& found = {});

 private:
  ompl::base::SpaceInformationPtr information_;
  ompl::base::GoalPtr goal_;
};
}  // namespace gpu_planning_scene::core
