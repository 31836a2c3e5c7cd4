#pragma once

#include <functional>
#include <string>

#include "collision/checkers/open_checker.h"
#include "service/make_checker.h"

namespace gpu_planning_scene::core
{
/// Returns a function that makes checkers. The function is thread-safe. If the first checker cannot open its device,
/// the function throws the error; but with the device "auto" or "all", it calls `warn` with one line, and the CPU
/// checks all states from then on. Later checkers open their devices in the background. `warn` also gets the checkers'
/// StateChecker::deviceWarning.
MakeChecker makeCheckers(const BatchCheckerOptions& options, const OpenDevice& open_device,
                         const std::function<void(const std::string&)>& warn);
}  // namespace gpu_planning_scene::core
