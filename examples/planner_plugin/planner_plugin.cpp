// A plugin that adds a planner to planning_scene_node. Requests name it planner_plugin/BKPIECE.

#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <pluginlib/class_list_macros.hpp>

#include <gpu_planning_scene/planning/planner_factory.h>

namespace planner_plugin
{
class BkpieceFactory : public gpu_planning_scene::core::PlannerFactoryOf<ompl::geometric::BKPIECE1>
{
};
}  // namespace planner_plugin

PLUGINLIB_EXPORT_CLASS(planner_plugin::BkpieceFactory, gpu_planning_scene::core::PlannerFactory)
