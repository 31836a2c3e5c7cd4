#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// Why a device must not be used: its driver is known to compute wrong answers that the tests at start-up do not find.
/// Such a device counts as unusable: `auto` and `all` pass it over, and a selector that names it is refused. Empty if
/// no fault is known. `renderer`: GL_RENDERER.
std::string driverFault(const std::string& renderer);
}  // namespace gpu_planning_scene::core
