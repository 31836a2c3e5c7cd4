#include "node/messages/requested_changes.h"

#include "gpu_planning_scene/error.h"
#include "node/messages/from_messages.h"

namespace gpu_planning_scene::core
{
std::vector<SceneChange> requestedChanges(const RobotModel& robot, const SceneLimits& limits,
                                          const PlanningSceneMessage& scene_diff, const RobotState& state,
                                          std::vector<std::string>& warnings)
{
  std::vector<SceneChange> changes;
  if (scene_diff != PlanningSceneMessage())
  {
    if (scene_diff.is_diff == 0)
      throw Error(
          "scene_diff: is_diff is false; set it to true, because a request can only change the scene and not "
          "replace it");
    changes.push_back(changeFrom(scene_diff, robot, limits, &warnings));
  }
  if (state != RobotState())
  {
    PlanningSceneMessage start;
    start.is_diff = 1;
    start.robot_state = state;
    if (state.attached_collision_objects.empty())
      start.robot_state.is_diff = 1;
    changes.push_back(changeFrom(start, robot, limits, &warnings));
  }
  return changes;
}

bool isEmpty(const AllowedCollisionMatrixMessage& matrix)
{
  return matrix.entry_names.empty() && matrix.entry_values.empty() && matrix.default_entry_names.empty() &&
         matrix.default_entry_values.empty();
}
}  // namespace gpu_planning_scene::core
