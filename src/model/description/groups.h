#pragma once

#include <set>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "model/description/srdf_reader.h"

namespace gpu_planning_scene::core
{
/// Resolves the groups of the SRDF as MoveIt does. Unknown links and joints, and chains with an unknown link, are left
/// out of their group. A group is left out if it contains itself, or if a subgroup is unknown or left out. Each gets a
/// line in `warnings`. `ignored_joints`: virtual joints that do not fit the robot.
std::vector<Group> resolveGroups(const std::vector<SrdfGroup>& groups, const RobotModel& robot,
                                 const std::set<std::string>& ignored_joints, std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
