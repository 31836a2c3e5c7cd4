#pragma once

#include <cstdint>
#include <vector>

#include "gpu_planning_scene/scene_change.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// The message that makes a scene. `components`: a sum of the numbers in PlanningSceneComponents; 0 for all. `state`,
/// `known`: for each variable its value, and whether the value is known. Unknown variables are left out.
PlanningSceneMessage messageOf(const PlanningScene& scene, std::uint32_t components, const std::vector<double>& state,
                               const std::vector<bool>& known);

/// The change that this message stands for.
SceneChange componentsOf(const PlanningScene& scene, std::uint32_t components, const std::vector<double>& state,
                         const std::vector<bool>& known);

/// The message that changeFrom() converts to `change`.
PlanningSceneMessage messageOf(const SceneChange& change, const RobotModel& robot);
}  // namespace gpu_planning_scene::core
