#pragma once

#include <vector>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Throws Error unless the shapes are leaves of one octree: cubes in its grid that do not overlap. See octreeOf().
void requireOctree(const std::vector<PlacedShape>& cubes);
}  // namespace gpu_planning_scene::core
