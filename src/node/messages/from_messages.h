#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/scene_change.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
// Convert messages to changes of a scene. All throw Error, which names the object and the fault. applyChange checks
// numbers, names and limits. The limits of a matrix are checked here, because a matrix needs far more memory than its
// message.

/// `warnings` (may be null) gets a line for each group of unused joints, and one for an unused matrix.
SceneChange changeFrom(const PlanningSceneMessage& message, const RobotModel& robot, const SceneLimits& limits,
                       std::vector<std::string>* warnings);
ObjectChange objectChangeFrom(const CollisionObject& message);
AttachedChange attachedChangeFrom(const AttachedCollisionObject& message);
AllowedCollisionMatrix matrixFrom(const AllowedCollisionMatrixMessage& message, const SceneLimits& limits);
}  // namespace gpu_planning_scene::core
