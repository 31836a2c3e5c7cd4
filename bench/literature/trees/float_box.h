#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gpu_planning_scene::core::literature
{
/// A box in the frame of a mesh.
struct FloatBox
{
  std::array<float, 3> lower;
  std::array<float, 3> upper;
};

/// The largest float that is not above the value.
inline float floatBelow(double value)
{
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) <= value ? rounded
                                               : std::nextafter(rounded, -std::numeric_limits<float>::infinity());
}

inline float floatAbove(double value)
{
  return -floatBelow(-value);
}

/// Moves a side of the box. `side`: 2 axis for the lower side, 2 axis + 1 for the upper side.
inline void cut(FloatBox& box, std::uint8_t side, float plane)
{
  (side % 2 == 0 ? box.lower : box.upper)[side / 2] = plane;
}
}  // namespace gpu_planning_scene::core::literature
