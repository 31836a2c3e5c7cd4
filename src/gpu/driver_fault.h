#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// Why a device must not be used: its driver is known to compute wrong answers that the tests at start-up do not find.
/// Empty if no fault is known. `renderer`: GL_RENDERER.
std::string driverFault(const std::string& renderer);
}  // namespace gpu_planning_scene::core
