#pragma once

#include <functional>
#include <memory>

#include "collision/checkers/resilient_checker.h"
#include "gpu_planning_scene/batch_checker.h"
#include "node/diagnostics.h"
#include "service/check_server.h"

namespace gpu_planning_scene::core
{
/// Makes the checker on the device that the options name; throws Error.
using OpenDevice = std::function<std::unique_ptr<StateChecker>(std::shared_ptr<const PlanningScene> scene,
                                                               const BatchCheckerOptions& options)>;

/// Makes checkers that outlive their device, and that diagnostics know of, which outlives what makes them. Until there
/// is one, what opening the device throws is thrown; after that the CPU stands in for a device that cannot be opened.
CheckServer::MakeChecker checkerMaker(const BatchCheckerOptions& options, const ResilientOptions& resilience,
                                      const OpenDevice& open_device, Diagnostics& diagnostics);
}  // namespace gpu_planning_scene::core
