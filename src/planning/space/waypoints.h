#pragma once

#include <vector>

#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/group_state_space.h"

namespace gpu_planning_scene::core
{
/// Index of the joint's variable that is an angle without limits (continuous and planar joints); -1 if there is none.
int wrappedAngle(const Joint& joint);

/// Adds to each angle of a planar or periodic continuous joint (isPeriodic) the whole turns that bring it nearest to
/// its value in `from`. A reader that interpolates the two rows as plain numbers then moves as interpolate() does.
void continueAngles(const RobotModel& robot, const std::vector<double>& from, std::vector<double>& row);

/// Turns a path into rows of all variables. `start`: the first row; all rows have its values of the other variables.
/// The values change in the direction in which the motions were checked, also for a reader that interpolates them as
/// plain numbers: angles continue from `start` without jumps by whole turns, and quaternions do not change their sign.
/// A motion of half a turn gets a waypoint at its middle, because both directions would be equally short.
std::vector<std::vector<double>> waypointsOf(const ompl::geometric::PathGeometric& path, const GroupStateSpace& space,
                                             const std::vector<double>& start);
}  // namespace gpu_planning_scene::core
