#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <gpu_planning_scene/PlanMotion.h>
#include <ros/node_handle.h>

#include "gpu_planning_scene/planning/plan_motion.h"
#include "node/messages/requested_states.h"
#include "planners/planner_configs.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
struct PlanServiceOptions
{
  double seconds = 5.0;              ///< planning time of a request that names none: ~planning/time
  double max_seconds = 120.0;        ///< ~limits/planning_time
  MotionCheckerOptions motions;      ///< ~planning/motion_rule, ~planning/resolution, ~planning/translation_resolution
  double max_deviation = 0.05;       ///< see PathTimingOptions: ~planning/max_deviation
  std::size_t at_once = 2;           ///< requests that are planned at the same time: ~planning/at_once
  std::size_t known_paths = 16;      ///< that are kept for each group: ~planning/known_paths
  std::size_t max_waiting = 16;      ///< queued requests: ~limits/waiting_plans
  std::size_t max_goals = 1000;      ///< goals of a request: ~limits/goals
  std::size_t max_parameter = 1000;  ///< largest value of a planner's parameter: ~limits/planner_parameter
};

/// Throws Error, which names the parameter.
PlanServiceOptions planOptionsFromParameters(const ros::NodeHandle& own);

/// The start of a request of ~plan. Throws Error for a wrong request.
RequestedState requestedStart(const PlanMotion::Request& request, const Snapshot& now);

/// Converts a request of ~plan to a query, without the goals that are regions. `start`: of requestedStart. `config`:
/// the configuration of the requested planner. `planners`: the settings of the requested group. Throws Error for a
/// wrong request.
PlanningQuery queryFrom(const PlanMotion::Request& request, const Snapshot& now, const RequestedState& start,
                        const PlannerConfig& config, const GroupPlanners& planners, const PlanServiceOptions& options);

/// Warnings about the start and the goals of a request that queryFrom has accepted: those of addStateWarnings, goals of
/// many turns, and a named start that replaces known values of variables outside the group, for example of another arm
/// that has a state of this name too.
std::vector<std::string> planWarnings(const PlanMotion::Request& request, const Snapshot& now,
                                      const RequestedState& start);
}  // namespace gpu_planning_scene::core
