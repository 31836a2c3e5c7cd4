#pragma once

#include <cstddef>
#include <string>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Throws Error if one of `count` motions moves a variable outside the group, because collisions of the links that only
/// such variables move are not checked. `group` may be empty. `starts`, `ends`: as for MotionChecker::check. `what`:
/// what the message calls a motion.
void requireMotionsOfGroup(const RobotModel& robot, const std::string& group, const double* starts, const double* ends,
                           std::size_t count, const std::string& what);
}  // namespace gpu_planning_scene::core
