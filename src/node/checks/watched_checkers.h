#pragma once

#include "node/endpoints/diagnostics.h"
#include "service/checker_maker.h"

namespace gpu_planning_scene::core
{
/// Returns a function that makes checkers as makeResilientCheckers does. It logs warnings, and registers each checker
/// with `diagnostics`, which must outlive the function.
CheckServer::MakeChecker makeWatchedCheckers(const BatchCheckerOptions& options, const ResilientOptions& resilience,
                                             const OpenDevice& open_device, Diagnostics& diagnostics);
}  // namespace gpu_planning_scene::core
