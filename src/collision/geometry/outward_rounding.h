#pragma once

#include <cmath>
#include <limits>

namespace gpu_planning_scene::core
{
/// A float that is greater than x.
inline float floatAbove(double x)
{
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

/// A float that is less than x.
inline float floatBelow(double x)
{
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
}  // namespace gpu_planning_scene::core
