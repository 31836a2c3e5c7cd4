#pragma once

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Padding of a link against the world, in metres, >= 0.
double paddingOf(const PlanningScene& scene, int link);

/// Padding of an attached object against the world, in metres, >= 0: the padding of its link plus its own padding.
double paddingOf(const PlanningScene& scene, const AttachedObject& attached);
}  // namespace gpu_planning_scene::core
