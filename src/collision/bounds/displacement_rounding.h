#pragma once

namespace gpu_planning_scene::core
{
/// An upper bound on a true displacement, from a computed bound. Both are in metres, at least 0, and may be infinite.
/// The bound is enlarged by more than the rounding of its sum and of forward kinematics and distances in double. Valid
/// within a kilometre of the origin of the planning frame.
inline double withRounding(double displacement)
{
  constexpr double kRelative = 1e-9;
  constexpr double kAbsolute = 1e-8;  // metres
  return displacement * (1.0 + kRelative) + kAbsolute;
}
}  // namespace gpu_planning_scene::core
