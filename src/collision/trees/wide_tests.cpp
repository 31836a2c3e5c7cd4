#include "collision/trees/wide_tests.h"

#include "base/instruction_sets.h"

namespace gpu_planning_scene::core
{
unsigned overlapAvx2(const WideNode& node, const FloatBox& box);
unsigned overlapBaseline(const WideNode& node, const FloatBox& box);
unsigned nearTrianglesAvx2(const TriangleBlock& a, const TriangleBlock& b, float distance);
unsigned nearTrianglesBaseline(const TriangleBlock& a, const TriangleBlock& b, float distance);

const std::vector<WideTests>& availableWideTests()
{
  static const std::vector<WideTests> tests = []
  {
    std::vector<WideTests> found;
#ifdef __x86_64__
    if (hasAvx2())
      found.push_back({"AVX2", overlapAvx2, nearTrianglesAvx2});
#endif
    found.push_back({"baseline", overlapBaseline, nearTrianglesBaseline});
    return found;
  }();
  return tests;
}
}  // namespace gpu_planning_scene::core
