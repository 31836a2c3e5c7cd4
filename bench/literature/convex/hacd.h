#pragma once

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// Hulls of an approximate convex decomposition.
MethodInfo hacdMethod();
}  // namespace gpu_planning_scene::core::literature
