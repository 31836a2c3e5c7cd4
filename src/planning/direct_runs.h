#pragma once

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/motion_validator.h"

namespace gpu_planning_scene::core
{
/// One motion instead of several that are no longer together, where it is found valid before `ptc`: planners cut long
/// motions into pieces.
void joinDirectRuns(ompl::geometric::PathGeometric& path, const MotionValidator& validator,
                    const ompl::base::PlannerTerminationCondition& ptc);
}  // namespace gpu_planning_scene::core
