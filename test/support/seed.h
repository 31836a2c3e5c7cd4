#pragma once

#include <cstdint>

namespace gpu_planning_scene::core
{
/// The seed of randomised tests. They print it when they fail.
constexpr std::uint64_t kSeed = 23;
}  // namespace gpu_planning_scene::core
