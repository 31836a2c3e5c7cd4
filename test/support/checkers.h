#pragma once

#include <string>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The checker called "cpu", "breadth_first" or "work_queue", with a copy of the scene. Each checker is made once per
/// process, because compiling shaders takes a while.
StateChecker& checkerOf(const std::string& name, const PlanningScene& scene);
}  // namespace gpu_planning_scene::core
