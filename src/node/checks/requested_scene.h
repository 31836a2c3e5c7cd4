#pragma once

#include <memory>
#include <optional>
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
  bool depends_on_state = false;                         ///< these changes place objects by the robot's state in `now`
  std::shared_ptr<const AllowedCollisionMatrix> matrix;  ///< of the request; null if it has none
  std::vector<std::string> warnings;
};

/// The store's scene, with the changes of a request (see requestedChanges). The store stays as it is. `lookup`: finds
/// frames that the scene does not have. Throws Error if the changes cannot be made, or if `scene_diff` and `matrix`
/// both have a matrix. `from`: the scene that the request names by its revision; no value: the newest scene.
RequestedScene requestedScene(const SceneStore& store, const SceneStore::Lookup& lookup,
                              const PlanningSceneMessage& scene_diff, const AllowedCollisionMatrixMessage& matrix,
                              const RobotState& state = {}, const std::optional<Snapshot>& from = {});
}  // namespace gpu_planning_scene::core
