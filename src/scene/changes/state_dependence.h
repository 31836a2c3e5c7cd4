#pragma once

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// Whether a change places an object where the robot's state puts it: it attaches an object of the world, detaches one,
/// or gives the pose of an object in the frame of another link or of an attached object. `scene`: the scene after the
/// change.
bool dependsOnRobotState(const PlanningScene& scene, const SceneChange& change);
}  // namespace gpu_planning_scene::core
