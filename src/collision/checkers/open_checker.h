#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "collision/batch/batch_device.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
class Scheduler;

/// The devices that a user has selected: the parts of "A+B", or all hardware devices for "all" ("auto" if there is
/// none). Throws Error for "all" if the EGL or OpenGL library is missing, and if a part is empty.
std::vector<std::string> devicesOf(const std::string& selection);

/// Opens a device that BatchCheckerOptions::device names alone.
using OpenDevice = std::function<std::unique_ptr<BatchDevice>(const BatchCheckerOptions& options)>;

/// A scheduler without a scene. Opens no device yet. Throws Error if an option is not valid.
std::unique_ptr<Scheduler> schedulerOf(const BatchCheckerOptions& options, const OpenDevice& open);

/// Opens the checker for a device: a CpuChecker if `options.device` is "cpu", else a BatchChecker. A device that the
/// user has named must work: otherwise it throws an Error that says what to do. For "auto" and "all", the CPU answers
/// if no device can be used, and `warn` gets one line. Throws Error if the scene or an option is not valid.
std::unique_ptr<StateChecker> openChecker(std::shared_ptr<const PlanningScene> scene,
                                          const BatchCheckerOptions& options,
                                          const std::function<void(const std::string&)>& warn);
}  // namespace gpu_planning_scene::core
