#pragma once

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// The change without its effect on the octomap, which sensors keep: a full scene and the removal of the octomap leave
/// it in `scene`. Throws Error if the change brings an octomap.
SceneChange keepingOctomap(SceneChange change, const PlanningScene& scene);
}  // namespace gpu_planning_scene::core
