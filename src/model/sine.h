#pragma once

namespace gpu_planning_scene::core
{
struct SineCosine
{
  double sine;
  double cosine;
};

/// Both to within 0.8 units in the last place (1e-20 next to multiples of pi / 2), by additions and multiplications
/// alone: the same bits on every machine and with every C library. Beyond |x| = 2^20 the C library's, which may differ
/// between machines.
SineCosine sineCosine(double x);
}  // namespace gpu_planning_scene::core
