#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/scene_change.h"
#include "node/messages.h"

namespace gpu_planning_scene::core
{
// Messages as changes of a scene. All throw Error, which names the object and what is wrong; numbers, names and limits
// are looked at by applyChange, but for those of a matrix, which takes far more memory than its message.

/// `warnings` (may be null) receives a line for what the robot cannot use of the state.
SceneChange changeFrom(const PlanningSceneMessage& message, const RobotModel& robot, const SceneLimits& limits,
                       std::vector<std::string>* warnings);
ObjectChange objectChangeFrom(const CollisionObject& message);
AttachedChange attachedChangeFrom(const AttachedCollisionObject& message);
AllowedCollisionMatrix matrixFrom(const AllowedCollisionMatrixMessage& message, const SceneLimits& limits);
}  // namespace gpu_planning_scene::core
