#pragma once

#include <functional>
#include <memory>

#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Makes a checker that has the scene.
using MakeChecker = std::function<std::shared_ptr<StateChecker>(std::shared_ptr<const PlanningScene>)>;
}  // namespace gpu_planning_scene::core
