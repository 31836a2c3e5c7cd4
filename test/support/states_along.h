#pragma once

#include <vector>

#include "gpu_planning_scene/interpolation.h"

namespace gpu_planning_scene::core
{
/// States along the straight motions between the rows of a path, to judge the path: rows of all variables, one after
/// another. `steps`: the largest steps between two states, by default a tenth of those of MotionChecker. A motion has
/// at least ten steps.
std::vector<double> statesAlong(const RobotModel& robot, const std::vector<std::vector<double>>& rows,
                                const MotionSteps& steps = {0.002, 0.002});
}  // namespace gpu_planning_scene::core
