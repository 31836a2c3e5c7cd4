#pragma once

#include <string>
#include <vector>

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// Embree's collision of two scenes. Empty if Embree cannot be used here.
std::vector<MethodInfo> embreeMethods();
/// The reason why Embree cannot be used here; empty if it can.
std::string whyNoEmbree();
}  // namespace gpu_planning_scene::core::literature
