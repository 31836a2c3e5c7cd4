#pragma once

namespace gpu_planning_scene::core
{
struct SineCosine
{
  double sine;
  double cosine;
};

/// Sine and cosine of an angle in radians, within 0.8 units in the last place (1e-20 near multiples of pi / 2). They
/// use only additions and multiplications, so all machines and C libraries give the same bits. For |x| > 2^20 the
/// result is the C library's, which can differ between machines.
SineCosine sineCosine(double x);
}  // namespace gpu_planning_scene::core
