#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The tip links of chains from the root link that make planning groups: the ends of the kinematic tree, and links from
/// which several moving branches start, for example a wrist with two fingers. Chains without a joint to move, and
/// chains that move the same joints as an earlier one, are left out.
std::vector<std::string> chainTips(const RobotModel& robot);
}  // namespace gpu_planning_scene::core
