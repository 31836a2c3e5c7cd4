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

/// The same; but if "auto" or "all" find a device that cannot check the scene, for example because the scene has too
/// many triangles, a CpuChecker checks it, and its deviceWarning says why.
std::unique_ptr<StateChecker> openCheckerOrCpu(const std::shared_ptr<const PlanningScene>& scene,
                                               const BatchCheckerOptions& options);
}  // namespace gpu_planning_scene::core
