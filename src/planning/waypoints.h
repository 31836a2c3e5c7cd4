#pragma once

#include <vector>

#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/group_state_space.h"

namespace gpu_planning_scene::core
{
/// The variable of a joint that is an angle without limits; -1 where it has none.
int wrappedAngle(const Joint& joint);

/// A path as rows of all variables, `start` first, whose other variables all have. Values go the way that the motions
/// were checked on, also for those who follow them number by number: angles go on from `start` without jumps by whole
/// turns, quaternions do not change their sign. Of a motion of half a turn the middle is a waypoint as well, as either
/// way round would be the shorter one.
std::vector<std::vector<double>> waypointsOf(const ompl::geometric::PathGeometric& path, const GroupStateSpace& space,
                                             const std::vector<double>& start);
}  // namespace gpu_planning_scene::core
