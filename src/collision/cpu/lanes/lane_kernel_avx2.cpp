// The lane kernel for AVX2. The code between GPS_BEGIN_TARGET and GPS_END_TARGET must not call functions that other
// files define inline: the linker may take this file's copy for all of them, and machines without AVX2 would stop
// there.
#include "base/instruction_sets.h"
#include "collision/cpu/lanes/lane_model.h"

#ifdef __x86_64__
GPS_BEGIN_TARGET("avx2,fma")
#define GPS_AVX
#define GPS_LANE_KERNEL proveAvx2
#include "collision/cpu/lanes/lane_kernel_body.h"
GPS_END_TARGET
#endif
