#pragma once

#include <vector>

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// CGAL's collision detection, in the process cgal_collide. Its CPU time is not part of that of the calling process.
std::vector<MethodInfo> cgalMethods();
}  // namespace gpu_planning_scene::core::literature
