#pragma once

#include <string>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The end of a message about a name that no link has: "has no link 'NAME'", then the nearest name of a link, or, if
/// none is near, the names of the first links.
std::string noLinkText(const RobotModel& robot, const std::string& name);
}  // namespace gpu_planning_scene::core
