#pragma once

#include <cstddef>
#include <functional>
#include <limits>

namespace gpu_planning_scene::core
{
/// A batch size that no batch reaches.
constexpr std::size_t kNoBatch = std::numeric_limits<std::size_t>::max();

/// Does work of a given size and returns its duration in seconds.
using TimedWork = std::function<double(std::size_t)>;

/// The size from which on `bulk`, which has a high fixed cost, is clearly faster (1.2 times) than `direct`. kNoBatch if
/// bulk does not seem to become faster. Both are timed at growing sizes up to kMaxTimed. This takes some tens of
/// milliseconds, or longer if already a few items take longer.
std::size_t breakEven(const TimedWork& direct, const TimedWork& bulk);
constexpr std::size_t kMaxTimed = 1024;
}  // namespace gpu_planning_scene::core
