// The lane kernel for the instruction set that all code of the project uses: SSE2 on x86-64, NEON on ARM.
#include "collision/cpu/lanes/lane_model.h"
#define GPS_LANE_KERNEL proveBaseline
#include "collision/cpu/lanes/lane_kernel_body.h"
