#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The variables whose limits are wider than those within which pairs with the reason Never were found free: the limits
/// that a comment of generate_acm gives (srdf_writer.h), else those of the URDF. `widened`: the variables whose limits
/// are wider than in the URDF. `srdf`: its text.
std::vector<std::string> limitsBeyondProofs(const std::vector<Variable>& variables, const std::vector<int>& widened,
                                            const std::string& srdf);
}  // namespace gpu_planning_scene::core
