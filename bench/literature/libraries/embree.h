#pragma once

#include <vector>

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// Embree's collision of two scenes.
std::vector<MethodInfo> embreeMethods();
}  // namespace gpu_planning_scene::core::literature
