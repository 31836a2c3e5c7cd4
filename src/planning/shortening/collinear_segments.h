#pragma once

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/motion_validator.h"

namespace gpu_planning_scene::core
{
/// Planners cut long motions into segments. This function joins them: it replaces a run of several motions by one
/// motion of the same length, if the validator finds this motion valid before `ptc` returns true.
void mergeCollinearSegments(ompl::geometric::PathGeometric& path, const MotionValidator& validator,
                            const ompl::base::PlannerTerminationCondition& ptc);
}  // namespace gpu_planning_scene::core
