#pragma once

#include <cstddef>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene
{
/// Allows the pairs of links that are adjacent, and those that collide in all or in none of the given states of the
/// robot.
void allowSampledPairs(const std::vector<double>& states, PlanningScene& scene);
}  // namespace gpu_planning_scene
