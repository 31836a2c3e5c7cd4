#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/messages.h"
#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene
{
// Messages as changes of a scene. All throw Error, which names the object and what is wrong; numbers, names and limits
// are looked at by applyChange, but for the matrix: its entries take many times the memory that they take in a message.

/// `warnings` (may be null) receives a line for what the robot cannot use of the state.
SceneChange changeFrom(const PlanningSceneMessage& message, const RobotModel& robot, const SceneLimits& limits,
                       std::vector<std::string>* warnings);
ObjectChange objectChangeFrom(const CollisionObject& message);
AttachedChange attachedChangeFrom(const AttachedCollisionObject& message);
/// `most_entries`: see SceneLimits::matrix_entries.
AllowedCollisionMatrix matrixFrom(const AllowedCollisionMatrixMessage& message, std::size_t most_entries);
}  // namespace gpu_planning_scene
