#pragma once

#include <vector>

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// The triangle meshes of the Open Dynamics Engine, which are those of OPCODE.
std::vector<MethodInfo> opcodeMethods();
}  // namespace gpu_planning_scene::core::literature
