#pragma once

#include <limits>

namespace gpu_planning_scene::core
{
constexpr double kPi = 3.14159265358979323846;

/// The distance from 1 to the next double.
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
}  // namespace gpu_planning_scene::core
