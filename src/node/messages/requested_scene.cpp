#include "node/messages/requested_scene.h"

#include "gpu_planning_scene/error.h"
#include "node/messages/from_messages.h"
#include "scene/matrix_entries.h"

namespace gpu_planning_scene::core
{
namespace
{
bool isEmpty(const AllowedCollisionMatrixMessage& matrix)
{
  return matrix.entry_names.empty() && matrix.entry_values.empty() && matrix.default_entry_names.empty() &&
         matrix.default_entry_values.empty();
}

/// The changes that a request makes to the scene for itself, in their order.
std::vector<SceneChange> requestedChanges(const SceneStore& store, const PlanningSceneMessage& scene_diff,
                                          const RobotState& state, std::vector<std::string>& warnings)
{
  const RobotModel& robot = *store.snapshot().scene->robot;
  std::vector<SceneChange> changes;
  if (scene_diff != PlanningSceneMessage())
  {
    if (scene_diff.is_diff == 0)
      throw Error(
          "scene_diff: is_diff is false; set it to true, because a request can only change the scene and not "
          "replace it");
    changes.push_back(changeFrom(scene_diff, robot, store.limits(), &warnings));
  }
  if (state != RobotState())
  {
    PlanningSceneMessage start;
    start.is_diff = 1;
    start.robot_state = state;
    if (state.attached_collision_objects.empty())
      start.robot_state.is_diff = 1;
    changes.push_back(changeFrom(start, robot, store.limits(), &warnings));
  }
  return changes;
}
}  // namespace

RequestedScene requestedScene(const SceneStore& store, const SceneStore::Lookup& lookup,
                              const PlanningSceneMessage& scene_diff, const AllowedCollisionMatrixMessage& matrix)
{
  return requestedScene(store, lookup, scene_diff, matrix, {});
}

RequestedScene requestedScene(const SceneStore& store, const SceneStore::Lookup& lookup,
                              const PlanningSceneMessage& scene_diff, const AllowedCollisionMatrixMessage& matrix,
                              const RobotState& state)
{
  RequestedScene requested;
  if (!isEmpty(matrix) && !isEmpty(scene_diff.allowed_collision_matrix))
    throw Error("allowed_collision_matrix is given in the request and in scene_diff; give one of the two");
  const std::vector<SceneChange> changes = requestedChanges(store, scene_diff, state, requested.warnings);
  requested.is_changed = !changes.empty();
  SceneStore::Preview preview = store.preview(changes, lookup);
  requested.now = std::move(preview.snapshot);
  requested.warnings.insert(requested.warnings.end(), preview.warnings.begin(), preview.warnings.end());
  if (!isEmpty(matrix))
  {
    requested.matrix = std::make_shared<const AllowedCollisionMatrix>(matrixFrom(matrix, store.limits()));
    if (std::string warning = warningOfDefaultsAlone(*requested.now.scene->robot, *requested.matrix); !warning.empty())
      requested.warnings.push_back(std::move(warning));
  }
  return requested;
}
}  // namespace gpu_planning_scene::core
