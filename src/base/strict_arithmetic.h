#pragma once
// The answers are exact only if the compiler does not reorder sums and rounds each double operation to double. A file
// that includes this header does not compile with the options of GCC that break this.

#include <cfloat>

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)
#error "gpu_planning_scene cannot be built with -ffast-math, -Ofast or -funsafe-math-optimizations: remove the option"
#endif
static_assert(FLT_EVAL_METHOD == 0, "on 32-bit x86, build gpu_planning_scene with -msse2 -mfpmath=sse");
