#pragma once

#include <ompl/base/Planner.h>

namespace gpu_planning_scene::core
{
/// Creates planners. It is the base class of planner plugins, because pluginlib needs a default constructor and
/// ompl::base::Planner has none. Thread-safe.
class PlannerFactory
{
 public:
  virtual ~PlannerFactory() = default;

  /// Creates a planner with its own default parameters. The space information has the GroupStateSpace, MotionValidator
  /// and StateValidityChecker of this package; a planner may use their functions that check many states or motions in
  /// one call.
  virtual ompl::base::PlannerPtr create(const ompl::base::SpaceInformationPtr& information) const = 0;
};
}  // namespace gpu_planning_scene::core
