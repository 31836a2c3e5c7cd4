#pragma once

#include <memory>
#include <string>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Compiles the shaders of the proofs for a robot with balls for links, with and without an attached object and
/// margins.
void compileProofShaders(const std::string& folder, const std::shared_ptr<const RobotModel>& robot,
                         const std::string& definitions);
}  // namespace gpu_planning_scene::core
