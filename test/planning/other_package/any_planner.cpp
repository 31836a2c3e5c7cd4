// What another package does to bring planners.

#include <memory>

#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/util/Exception.h>
#include <pluginlib/class_list_macros.hpp>

#include "gpu_planning_scene/planning/planner_factory.h"

namespace other_package
{
class AnyPlanner : public gpu_planning_scene::PlannerFactory
{
 public:
  ompl::base::PlannerPtr create(const ompl::base::SpaceInformationPtr& information) const override
  {
    return std::make_shared<ompl::geometric::BKPIECE1>(information);
  }
};

class Broken : public gpu_planning_scene::PlannerFactory
{
 public:
  ompl::base::PlannerPtr create(const ompl::base::SpaceInformationPtr& /*information*/) const override
  {
    throw ompl::Exception("a planner that is broken");
  }
};
}  // namespace other_package

PLUGINLIB_EXPORT_CLASS(other_package::Broken, gpu_planning_scene::PlannerFactory)
PLUGINLIB_EXPORT_CLASS(other_package::AnyPlanner, gpu_planning_scene::PlannerFactory)
