#pragma once

#include <string>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The end of a message about a name that no link has: "has no link 'NAME'", then the nearest name of a link, or, if
/// none is near, the names of the first links.
std::string noLinkText(const RobotModel& robot, const std::string& name);

/// The index of the link. Throws Error, which begins with `where`, if the robot has no such link.
int requireLink(const RobotModel& robot, const std::string& name, const std::string& where);
}  // namespace gpu_planning_scene::core
