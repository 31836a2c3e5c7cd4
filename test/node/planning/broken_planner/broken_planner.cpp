// A plugin whose planner cannot be created.

#include <ompl/util/Exception.h>
#include <pluginlib/class_list_macros.hpp>

#include "gpu_planning_scene/planning/planner_factory.h"

namespace broken_planner
{
class Broken : public gpu_planning_scene::core::PlannerFactory
{
 public:
  ompl::base::PlannerPtr create(const ompl::base::SpaceInformationPtr& /*information*/) const override
  {
    throw ompl::Exception("a planner that is broken");
  }
};
}  // namespace broken_planner

PLUGINLIB_EXPORT_CLASS(broken_planner::Broken, gpu_planning_scene::core::PlannerFactory)
