#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/messages.h"
#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene
{
// Messages as changes of a scene. All throw Error, which names the object and what is wrong; numbers, names and limits
// are looked at by applyChange.

/// `warnings` (may be null) receives a line for what the robot cannot use of the state.
SceneChange changeFrom(const PlanningSceneMessage& message, const RobotModel& robot,
                       std::vector<std::string>* warnings);
ObjectChange objectChangeFrom(const CollisionObject& message);
AttachedChange attachedChangeFrom(const AttachedCollisionObject& message);
AllowedCollisionMatrix matrixFrom(const AllowedCollisionMatrixMessage& message);
}  // namespace gpu_planning_scene
