#pragma once

#include <vector>

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// FCL's trees of OBB, RSS, OBBRSS and kIOS.
std::vector<MethodInfo> fclMethods();
}  // namespace gpu_planning_scene::core::literature
