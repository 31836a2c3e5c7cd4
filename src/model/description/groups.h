#pragma once

#include <set>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "model/description/srdf_reader.h"

namespace gpu_planning_scene::core
{
/// Resolves the groups of the SRDF as MoveIt does. Throws Error for unknown links, joints and subgroups, for
/// unconnected chains, and for groups that contain themselves. A joint in `ignored_joints` (virtual joints that do not
/// fit the robot) gives a warning.
std::vector<Group> resolveGroups(const std::vector<SrdfGroup>& groups, const RobotModel& robot,
                                 const std::set<std::string>& ignored_joints, std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
