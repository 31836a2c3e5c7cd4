#include "collision/cpu/lanes/lane_kernel.h"

#include "base/instruction_sets.h"

namespace gpu_planning_scene::core::lanes
{
void proveAvx512(const Model& model, const double* states, int count, const float* margins, const Scratch& scratch,
                 Block& block);
void proveAvx2(const Model& model, const double* states, int count, const float* margins, const Scratch& scratch,
               Block& block);
void proveBaseline(const Model& model, const double* states, int count, const float* margins, const Scratch& scratch,
                   Block& block);

const std::vector<NamedKernel>& availableKernels()
{
  static const std::vector<NamedKernel> kernels = []
  {
    std::vector<NamedKernel> found;
#ifdef __x86_64__
    if (hasAvx512())
      found.push_back({"AVX-512", proveAvx512});
    if (hasAvx2())
      found.push_back({"AVX2", proveAvx2});
#endif
    found.push_back({"baseline", proveBaseline});
    return found;
  }();
  return kernels;
}
}  // namespace gpu_planning_scene::core::lanes
