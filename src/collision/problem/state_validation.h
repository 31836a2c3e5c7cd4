#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"
#include "model/joint_limits.h"

namespace gpu_planning_scene::core
{
/// Throws Error if there is no scene, or if the scene has no robot.
void requireRobot(const std::shared_ptr<const PlanningScene>& scene);

/// Throws Error if `around` does not fit `count` states of this robot, or if a joint travel is not finite or below 0.
void validateNeighbourhood(const RobotModel& robot, const JointNeighbourhood& around, std::size_t count);

/// Throws Error if one of `count` states (rows of the robot's variables) has a value that is not finite or exceeds
/// Variable::largest in magnitude. `what`: what the message calls a row.
void validateStates(const RobotModel& robot, const double* states, std::size_t count, const char* what = "state");

/// The values of a state (a row of the robot's variables) that are outside of `ranges`, which are joint limits.
ValuesOutsideLimits valuesOutside(const std::vector<VariableRange>& ranges, const RobotModel& robot,
                                  const double* state);
}  // namespace gpu_planning_scene::core
