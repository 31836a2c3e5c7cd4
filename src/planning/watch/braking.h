#pragma once

#include "gpu_planning_scene/planning/trajectory_watch.h"

namespace gpu_planning_scene::core
{
/// The latest time at which the robot can begin to brake so that it stands at the time `until` of the motion: see
/// MotionOutlook::brake_by. If the robot would have to brake before the motion begins: minus infinity.
double latestBraking(const RobotModel& robot, const TimedRows& motion, double until);
}  // namespace gpu_planning_scene::core
