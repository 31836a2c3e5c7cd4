#pragma once

#include <vector>

#include "collision/trees/wide_overlap.h"
#include "collision/trees/wide_triangles.h"

namespace gpu_planning_scene::core
{
/// The tests of wide trees for one instruction set.
struct WideTests
{
  const char* instructions;
  OverlapTest overlap;
  NearTrianglesTest near_triangles;
};

/// The tests that this machine can run, the widest instruction set first. All have the same sources,
/// wide_overlap_body.h and wide_triangles_body.h.
const std::vector<WideTests>& availableWideTests();
}  // namespace gpu_planning_scene::core
