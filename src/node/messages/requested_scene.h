#pragma once

#include <functional>
#include <string>
#include <vector>

#include "node/messages/messages.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// The scene of one request.
struct RequestedScene
{
  Snapshot now;
  bool is_changed = false;                               ///< the request changes the scene for itself
  std::shared_ptr<const AllowedCollisionMatrix> matrix;  ///< of the request; null if it has none
  std::vector<std::string> warnings;
};

/// The store's scene, with the changes of a request. The store stays as it is. `scene_diff`: empty, or a difference.
/// `lookup`: finds frames that the scene does not have. Throws Error if `scene_diff` is a full scene, if it cannot be
/// applied, or if it and `matrix` both give a matrix.
RequestedScene requestedScene(const SceneStore& store, const SceneStore::Lookup& lookup,
                              const PlanningSceneMessage& scene_diff, const AllowedCollisionMatrixMessage& matrix);

/// The same, and then with a robot state. If the state has no attached objects, the links keep theirs.
RequestedScene requestedScene(const SceneStore& store, const SceneStore::Lookup& lookup,
                              const PlanningSceneMessage& scene_diff, const AllowedCollisionMatrixMessage& matrix,
                              const RobotState& state);
}  // namespace gpu_planning_scene::core
