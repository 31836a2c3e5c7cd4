#pragma once

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/motion_validator.h"

namespace gpu_planning_scene::core
{
/// Replaces runs of several motions by one motion of the same length, if it is found valid before `ptc` holds. So it
/// joins the segments into which planners cut long motions.
void mergeCollinearSegments(ompl::geometric::PathGeometric& path, const MotionValidator& validator,
                            const ompl::base::PlannerTerminationCondition& ptc);
}  // namespace gpu_planning_scene::core
