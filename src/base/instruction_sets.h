#pragma once

// The functions between GPS_BEGIN_TARGET("avx2,fma") and GPS_END_TARGET are compiled for the named instruction sets.
// Clang ignores GCC's pragma for this.
#define GPS_PRAGMA(text) _Pragma(#text)
#ifdef __clang__
#define GPS_BEGIN_TARGET(sets) GPS_PRAGMA(clang attribute push(__attribute__((target(sets))), apply_to = function))
#define GPS_END_TARGET GPS_PRAGMA(clang attribute pop)
#else
#define GPS_BEGIN_TARGET(sets) GPS_PRAGMA(GCC push_options) GPS_PRAGMA(GCC target sets)
#define GPS_END_TARGET GPS_PRAGMA(GCC pop_options)
#endif

namespace gpu_planning_scene::core
{
/// Whether this machine has AVX2 and FMA. Kernels for wider instruction sets than the project's are chosen by this
/// function and the next one, when they are first used.
inline bool hasAvx2()
{
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

/// Whether it also has the parts F, VL and DQ of AVX-512.
inline bool hasAvx512()
{
#ifdef __x86_64__
  return hasAvx2() && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
         __builtin_cpu_supports("avx512dq") != 0;
#else
  return false;
#endif
}
}  // namespace gpu_planning_scene::core
