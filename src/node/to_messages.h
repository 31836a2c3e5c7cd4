#pragma once

#include <cstdint>
#include <vector>

#include "gpu_planning_scene/scene_change.h"
#include "node/messages.h"

namespace gpu_planning_scene::core
{
/// A scene as the message that makes it. `components`: a sum of PlanningSceneComponents' numbers, 0 for all. `state`
/// and `known`: of each variable its value, and whether it is known; those that are not are left out.
PlanningSceneMessage messageOf(const PlanningScene& scene, std::uint32_t components, const std::vector<double>& state,
                               const std::vector<bool>& known);

/// The message that changeFrom makes `change` of.
PlanningSceneMessage messageOf(const SceneChange& change, const RobotModel& robot);
}  // namespace gpu_planning_scene::core
