#pragma once

#include <memory>

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

/// Creates planners of one class, which has a constructor with the space information as its only argument.
template <class Planner>
class PlannerFactoryOf : public PlannerFactory
{
 public:
  ompl::base::PlannerPtr create(const ompl::base::SpaceInformationPtr& information) const override
  {
    return std::make_shared<Planner>(information);
  }
};
}  // namespace gpu_planning_scene::core
