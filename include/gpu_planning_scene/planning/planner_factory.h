#pragma once

#include <ompl/base/Planner.h>

namespace gpu_planning_scene::core
{
/// Makes planners: the base class of plugins, as ompl::base::Planner has no default constructor. Thread-safe.
class PlannerFactory
{
 public:
  virtual ~PlannerFactory() = default;

  /// A planner with its own defaults. The space information has a GroupStateSpace, a MotionValidator and a
  /// StateValidityChecker of this package, which planners may use in bulk.
  virtual ompl::base::PlannerPtr create(const ompl::base::SpaceInformationPtr& information) const = 0;
};
}  // namespace gpu_planning_scene::core
