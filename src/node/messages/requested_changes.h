#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/scene_change.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// The changes that a request makes to the scene for itself, in their order. `scene_diff`: empty, or a difference.
/// `state`: empty, or a robot state that is set after the difference; if it has no attached objects, the links keep
/// theirs. `warnings` gets the warnings of changeFrom. Throws Error if `scene_diff` is a full scene, and the errors of
/// changeFrom.
std::vector<SceneChange> requestedChanges(const RobotModel& robot, const SceneLimits& limits,
                                          const PlanningSceneMessage& scene_diff, const RobotState& state,
                                          std::vector<std::string>& warnings);

/// True if the message sets no matrix.
bool isEmpty(const AllowedCollisionMatrixMessage& matrix);
}  // namespace gpu_planning_scene::core
