#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
/// States close to where the robot touches something: on the straight way between a free and a colliding random state
/// the place of contact is bisected to the resolution of doubles, then left again by a step that moves links by about
/// 1e-10 ... 1e-4 m, uniform in its logarithm. Every other state lies on the colliding side. The same for the same
/// seed.
std::vector<double> nearContactStates(const TestScene& scene, std::size_t count, std::uint64_t seed);
}  // namespace gpu_planning_scene::core
