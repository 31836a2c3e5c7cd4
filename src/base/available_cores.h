#pragma once

#include <cstddef>

namespace gpu_planning_scene::core
{
/// The number of cores on which this process may run, at least 1: those of its main thread's affinity at the first
/// call. Thread-safe.
std::size_t availableCores();
}  // namespace gpu_planning_scene::core
