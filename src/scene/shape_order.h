#pragma once

#include <vector>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Messages list the primitives of an object, then its meshes, then its planes, and a move names poses in that order:
/// so lie an object's shapes, from wherever they came.
void orderShapes(std::vector<PlacedShape>& shapes);
}  // namespace gpu_planning_scene::core
