// The lane kernel for AVX2. The code between the pragmas must not call functions that other files define inline: the
// linker may take this file's copy for all of them, and machines without AVX2 would stop there.
#include "collision/cpu/lanes/lane_model.h"

#ifdef __x86_64__
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#endif
#define GPS_AVX
#define GPS_LANE_KERNEL proveAvx2
#include "collision/cpu/lanes/lane_kernel_body.h"
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif
