#pragma once

#include <vector>

#include "gpu_planning_scene/planning/path_timing.h"
#include "planning/timing/blended_path.h"

namespace gpu_planning_scene::core
{
/// The points of a motion: the boundaries of its phases, and further points so that interpolation between them follows
/// the phases. `goal`: the last position. Without phases, the result is one point at the goal.
std::vector<TimedPoint> timedPoints(const std::vector<Phase>& phases, const std::vector<double>& goal);
}  // namespace gpu_planning_scene::core
