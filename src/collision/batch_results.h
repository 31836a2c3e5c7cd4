#pragma once

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene
{
/// Adds the answer for some states to that for those before them.
void append(const BatchResult& part, BatchResult& all);
}  // namespace gpu_planning_scene
