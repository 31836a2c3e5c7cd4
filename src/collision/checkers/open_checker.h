#pragma once

#include <functional>
#include <memory>
#include <string>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Opens the checker for a device: a CpuChecker if `options.device` is "cpu", else a BatchChecker. There is no silent
/// fallback: if the device cannot be used, it throws an Error that says what to do.
std::unique_ptr<StateChecker> openChecker(std::shared_ptr<const PlanningScene> scene,
                                          const BatchCheckerOptions& options);

/// The same for programs that need answers and not a certain device. With the device "auto" or "all", the CPU answers
/// if the device fails, now or later, and `warn` gets one line (see FallbackChecker). Throws Error if there is no
/// device at all, or if the scene or an option is not valid.
std::unique_ptr<StateChecker> openWithFallback(std::shared_ptr<const PlanningScene> scene,
                                               const BatchCheckerOptions& options,
                                               std::function<void(const std::string&)> warn);
}  // namespace gpu_planning_scene::core
