#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/planning/path_timing.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A planned motion and its goals, for RViz. States are rows of all variables.
struct ShownPlan
{
  std::shared_ptr<const PlanningScene> scene;
  Group group;
  std::vector<double> start;
  std::vector<KinematicConstraints> goal_regions;  ///< of the request: PlanningQuery::goal_regions
  PlanningStatus status = PlanningStatus::NoSolution;
  std::string message;                         ///< the fault, in one line
  std::vector<std::vector<double>> waypoints;  ///< empty without a path
  std::optional<TimedPath> timed;              ///< if the request wants times
};
}  // namespace gpu_planning_scene::core
