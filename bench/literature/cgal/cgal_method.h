#pragma once

#include <string>
#include <vector>

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// CGAL's collision detection, in the process cgal_collide, whose CPU time otherCpuSeconds reports. No method if
/// this program is missing, as in the bundle for other machines.
std::vector<MethodInfo> cgalMethods();
/// The reason why CGAL cannot be used here; empty if it can.
std::string whyNoCgal();
}  // namespace gpu_planning_scene::core::literature
