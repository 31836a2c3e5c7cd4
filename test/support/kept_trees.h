#pragma once

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Keeps the CPU's trees of the scene's shapes until the process ends. All checkers of a process share trees that are
/// in use, see cpuTreeOf, so the tests of a suite build the trees of a real robot once and not once per checker.
void keepTrees(const PlanningScene& scene);
}  // namespace gpu_planning_scene::core
