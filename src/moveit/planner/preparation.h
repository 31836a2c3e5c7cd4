#pragma once

#include <moveit/robot_model/robot_model.h>

#include "moveit/planner/planning_context.h"

namespace gpu_planning_scene::pipeline
{
/// Makes a checker and lets it check states of the robot beside a box, with and without neighbourhoods. Throws
/// core::Error or Refusal if the robot or the device cannot be used.
void prepareChecker(Workshop& workshop, const moveit::core::RobotModelConstPtr& model);
}  // namespace gpu_planning_scene::pipeline
