#pragma once

#include <cstddef>
#include <functional>

#include "base/parallel_for.h"
#include "collision/problem/state_range.h"

namespace gpu_planning_scene::core
{
/// Writes states: row-major rows of the robot's variables. Called on several threads at once.
using CopyStates = std::function<void(const StateRange& states, double* to)>;

/// Copies states on all cores. `width`: the number of variables.
inline void copyOnAllCores(const CopyStates& copy, const StateRange& states, std::size_t width, double* to)
{
  constexpr std::size_t kRowsPerChunk = 16'384;  // copying these takes longer than starting a thread
  parallelFor(states.count, kRowsPerChunk,
              [&](std::size_t from, std::size_t end) {
                copy({states.begin + from, end - from}, to + from * width);
              });
}
}  // namespace gpu_planning_scene::core
