#pragma once

#include <cstddef>

#include <ros/node_handle.h>

#include "gpu_planning_scene/PlanMotion.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "node/planner_configs.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
struct PlanServiceOptions
{
  double seconds = 5.0;               ///< of a request that asks for no time: ~planning/time
  double most_seconds = 120.0;        ///< ~limits/planning_time
  MotionCheckerOptions motions;       ///< ~planning/motion_rule, ~planning/resolution, ~planning/translation_resolution
  std::size_t at_once = 2;            ///< plannings: ~planning/at_once
  std::size_t most_waiting = 16;      ///< ~limits/waiting_plans
  std::size_t most_goals = 1000;      ///< ~limits/goals
  std::size_t most_parameter = 1000;  ///< largest number that a planner's parameter can be: ~limits/planner_parameter
};

/// Throws Error, which names the parameter.
PlanServiceOptions planOptionsFromParameters(const ros::NodeHandle& own);

/// What a request of ~plan asks for. `config`: of its planner; `planners`: of its group. Throws Error.
PlanningQuery queryFrom(const PlanMotion::Request& request, const Snapshot& now, const PlannerConfig& config,
                        const GroupPlanners& planners, const PlanServiceOptions& options);
}  // namespace gpu_planning_scene::core
