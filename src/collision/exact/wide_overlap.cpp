#include "collision/exact/wide_overlap.h"

namespace gpu_planning_scene::core
{
unsigned overlapAvx2(const WideNode& node, const FloatBox& box);
unsigned overlapBaseline(const WideNode& node, const FloatBox& box);

const std::vector<NamedOverlapTest>& availableOverlapTests()
{
  static const std::vector<NamedOverlapTest> tests = []
  {
    std::vector<NamedOverlapTest> found;
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      found.push_back({"AVX2", overlapAvx2});
#endif
    found.push_back({"baseline", overlapBaseline});
    return found;
  }();
  return tests;
}
}  // namespace gpu_planning_scene::core
