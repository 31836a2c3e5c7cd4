#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "support/test_scenes.h"

namespace gpu_planning_scene::core::benchmark
{
/// "random": uniform in the scene's ranges. "near_contact": within about 1e-10 ... 1e-4 m of contact, one half free.
/// "motion": straight motions in joint space between random states, 64 states each, like the edges of a planner.
const std::vector<std::string>& stateKinds();

/// Returns `count` rows. Deterministic for a given seed.
std::vector<double> makeStates(const TestScene& scene, const std::string& kind, std::size_t count, std::uint64_t seed);
}  // namespace gpu_planning_scene::core::benchmark
