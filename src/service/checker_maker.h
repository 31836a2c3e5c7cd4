#pragma once

#include <functional>
#include <memory>
#include <string>

#include "collision/checkers/resilient_checker.h"
#include "gpu_planning_scene/batch_checker.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// Makes a checker on the device that the options name. Throws Error.
using OpenDevice = std::function<std::unique_ptr<StateChecker>(std::shared_ptr<const PlanningScene> scene,
                                                               const BatchCheckerOptions& options)>;

/// Returns a function that makes checkers that survive the loss of their device. The function is thread-safe. If the
/// first checker cannot open its device, the function throws the error; but with the device "auto" or "all", it calls
/// `warn` with one line, and the CPU checks all states from then on. If a later checker cannot open its device, the CPU
/// answers for it. `warn` also gets the checkers' StateChecker::deviceWarning.
CheckServer::MakeChecker makeResilientCheckers(const BatchCheckerOptions& options, const ResilientOptions& resilience,
                                               const OpenDevice& open_device,
                                               const std::function<void(const std::string&)>& warn);
}  // namespace gpu_planning_scene::core
