#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// "elbow (-1.57 to 1.57)"; the name alone if there are no limits. The limits have so many digits that a request may
/// use them as values.
std::string describeVariable(const Variable& variable);

/// A line for each source of limits other than the URDF's <limit>, with the variables that have their limits from it.
std::vector<std::string> describeLimitSources(const RobotModel& robot);

/// Lines for a person who writes a request: the variables with their limits (radians, metres), the planning groups, and
/// the named states of the SRDF. A line is left out if the robot has none of its kind.
std::vector<std::string> describeRobot(const RobotModel& robot);
}  // namespace gpu_planning_scene::core
