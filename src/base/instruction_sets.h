#pragma once

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
