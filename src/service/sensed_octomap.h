#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// The change without its effect on the octomap of `scene`, which sensors keep. A change that brings or removes an
/// octomap gets a warning; a full scene without an octomap gets none.
SceneChange keepingOctomap(SceneChange change, const PlanningScene& scene, std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
