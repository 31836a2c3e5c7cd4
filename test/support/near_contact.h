#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
/// States in which the robot almost touches something. On the segment between a free and a colliding random state,
/// bisection finds a contact to the resolution of double. The state is then moved away from the contact by a
/// step that displaces links by about 1e-10 ... 1e-4 m, uniform in its logarithm. Every other state lies on the
/// colliding side. The same seed gives the same states.
std::vector<double> nearContactStates(const TestScene& scene, std::size_t count, std::uint64_t seed);
}  // namespace gpu_planning_scene::core
