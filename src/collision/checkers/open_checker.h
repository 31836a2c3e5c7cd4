#pragma once

#include <memory>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Opens the checker for a device: a CpuChecker if `options.device` is "cpu", else a BatchChecker. There is no silent
/// fallback: if the device cannot be used, it throws an Error that says what to do.
std::unique_ptr<StateChecker> openChecker(std::shared_ptr<const PlanningScene> scene,
                                          const BatchCheckerOptions& options);
}  // namespace gpu_planning_scene::core
