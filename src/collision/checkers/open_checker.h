#pragma once

#include <memory>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The checker for a device: BatchChecker, or CpuChecker where `options.device` is "cpu". There is no silent fallback:
/// without a usable device it throws Error, which says what to do.
std::unique_ptr<StateChecker> openChecker(std::shared_ptr<const PlanningScene> scene,
                                          const BatchCheckerOptions& options);
}  // namespace gpu_planning_scene::core
