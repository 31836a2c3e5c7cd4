#pragma once
// The answers are exact only if the compiler keeps to IEEE 754: double operations are rounded once, to double, in the
// order of the program. A package that includes this header does not compile otherwise.

#include <cfloat>

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)
#error "gpu_planning_scene cannot be built with -ffast-math, -Ofast or -funsafe-math-optimizations: remove the option"
#endif
static_assert(FLT_EVAL_METHOD == 0, "on 32-bit x86, build gpu_planning_scene with -msse2 -mfpmath=sse");
