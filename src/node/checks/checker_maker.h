#pragma once

#include <functional>
#include <memory>

#include "collision/checkers/resilient_checker.h"
#include "gpu_planning_scene/batch_checker.h"
#include "node/endpoints/diagnostics.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// Makes a checker on the device that the options name. Throws Error.
using OpenDevice = std::function<std::unique_ptr<StateChecker>(std::shared_ptr<const PlanningScene> scene,
                                                               const BatchCheckerOptions& options)>;

/// Returns a function that makes checkers. A checker survives the loss of its device and is registered with
/// `diagnostics`, which must outlive the function. If the first checker cannot open its device, the function throws the
/// error; but with the device "auto", it warns, and the CPU checks all states from then on. If a later checker cannot
/// open its device, the CPU answers for it.
CheckServer::MakeChecker checkerMaker(const BatchCheckerOptions& options, const ResilientOptions& resilience,
                                      const OpenDevice& open_device, Diagnostics& diagnostics);
}  // namespace gpu_planning_scene::core
