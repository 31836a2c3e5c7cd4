#pragma once

#include <vector>

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// Bullet's collision test of two moving meshes.
std::vector<MethodInfo> gimpactMethods();
}  // namespace gpu_planning_scene::core::literature
