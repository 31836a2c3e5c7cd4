#pragma once

#include <cstddef>
#include <functional>
#include <limits>

namespace gpu_planning_scene::core
{
/// The batch size that nothing reaches.
constexpr std::size_t kNoBatch = std::numeric_limits<std::size_t>::max();

/// Does some work of a given size and returns how many seconds it took.
using TimedWork = std::function<double(std::size_t)>;

/// From which size on `bulk`, which takes long to start, is clearly faster (1.2 times) than `direct`; kNoBatch if it
/// seems never to be. Both are timed at growing sizes up to kMostTimed, for some tens of milliseconds unless few items
/// take longer.
std::size_t breakEven(const TimedWork& direct, const TimedWork& bulk);
constexpr std::size_t kMostTimed = 1024;
}  // namespace gpu_planning_scene::core
