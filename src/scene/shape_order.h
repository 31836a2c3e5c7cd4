#pragma once

#include <vector>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Sorts the shapes of an object: primitives, then meshes, then planes. Messages list them in this order, and a move
/// gives their poses in this order. So all objects keep it, whatever their source.
void orderShapes(std::vector<PlacedShape>& shapes);
}  // namespace gpu_planning_scene::core
