#pragma once

#include <string>
#include <vector>

#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
/// A box in the gripper of ur5_robotiq, and the links that may touch it.
WorldObject boxInGripper(const RobotModel& robot, const double* state);
const std::vector<std::string>& gripperLinks();

/// "ur5_table_pick" with further features: a box that the gripper carries, a padding of 5 mm for links and of 2 mm for
/// objects, and a floor that is a half-space.
TestScene carryingScene();
}  // namespace gpu_planning_scene::core
