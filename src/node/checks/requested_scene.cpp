#include "node/checks/requested_scene.h"

#include <algorithm>
#include <utility>

#include "gpu_planning_scene/error.h"
#include "node/messages/from_messages.h"
#include "node/messages/requested_changes.h"
#include "scene/changes/matrix_entries.h"
#include "scene/changes/state_dependence.h"

namespace gpu_planning_scene::core
{
RequestedScene requestedScene(const SceneStore& store, const SceneStore::Lookup& lookup,
                              const PlanningSceneMessage& scene_diff, const AllowedCollisionMatrixMessage& matrix,
                              const RobotState& state, const std::optional<Snapshot>& from)
{
  RequestedScene requested;
  if (!isEmpty(matrix) && !isEmpty(scene_diff.allowed_collision_matrix))
    throw Error("allowed_collision_matrix is given in the request and in scene_diff; give one of the two");
  const std::vector<SceneChange> changes =
      requestedChanges(*store.snapshot().scene->robot, store.limits(), scene_diff, state, requested.warnings);
  requested.is_changed = !changes.empty();
  SceneStore::Preview preview = store.preview(changes, lookup, from);
  requested.now = std::move(preview.snapshot);
  requested.depends_on_state = std::any_of(changes.begin(), changes.end(),
                                           [&requested](const SceneChange& change)
                                           { return dependsOnRobotState(*requested.now.scene, change); });
  requested.warnings.insert(requested.warnings.end(), preview.warnings.begin(), preview.warnings.end());
  if (!requested.now.octomap_fault.empty())
    requested.warnings.push_back(requested.now.octomap_fault);
  if (isEmpty(matrix))
    return requested;
  requested.matrix = std::make_shared<const AllowedCollisionMatrix>(matrixFrom(matrix, store.limits()));
  for (std::string& warning : warningsOfMatrix(*requested.now.scene->robot, *requested.matrix))
    requested.warnings.push_back(std::move(warning));
  return requested;
}
}  // namespace gpu_planning_scene::core
