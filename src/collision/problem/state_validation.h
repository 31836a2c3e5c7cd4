#pragma once

#include <cstddef>
#include <memory>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Throws Error if there is no scene, or it has no robot.
void requireRobot(const std::shared_ptr<const PlanningScene>& scene);

/// Throws Error where `around` is not for `count` states of this robot, or one of its ways is not finite and at least
/// 0.
void validateNeighbourhood(const RobotModel& robot, const JointNeighbourhood& around, std::size_t count);

/// Throws Error if one of `count` rows of the robot's variables holds a value that is not finite or beyond
/// Variable::largest.
void validateStates(const RobotModel& robot, const double* states, std::size_t count);
}  // namespace gpu_planning_scene::core
