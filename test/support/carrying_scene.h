#pragma once

#include <string>
#include <vector>

#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
/// A box and the links that may touch it, for the gripper of ur5_robotiq.
WorldObject boxInGripper(const RobotModel& robot, const double* state);
const std::vector<std::string>& gripperLinks();

/// "ur5_table_pick" with all that the scene lacks: a box that the gripper carries, links padded by 5 mm and objects by
/// 2 mm, and a floor, which is a half-space.
TestScene carryingScene();
}  // namespace gpu_planning_scene::core
