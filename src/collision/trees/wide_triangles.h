#pragma once

#include <cstdint>

namespace gpu_planning_scene::core
{
constexpr unsigned kBlockTriangles = 4;

/// The triangles of a leaf as floats, as a structure of arrays. Slots beyond `count` repeat the last triangle.
struct alignas(16) TriangleBlock
{
  float corners[3][3][kBlockTriangles];  ///< [i][k]: coordinate k of corner i
  std::uint32_t first;                   ///< the number of the leaf's first triangle in its tree
  std::uint32_t count;                   ///< 1 to kBlockTriangles
};

/// Tests each triangle of `a` against each triangle of `b`, in the same frame, by possible separating axes: the line
/// of their centres, both normals, and the products of their edges (e.g. Ericson, "Real-Time Collision Detection",
/// 2005, section 5.2). `distance`: the required distance plus the rounding errors, see WidePlacement::distance. If bit
/// kBlockTriangles * j + i of the result is 0, then triangle i of `a` and triangle j of `b` are farther apart than the
/// required distance, or one of them does not exist. Thread-safe.
using NearTrianglesTest = unsigned (*)(const TriangleBlock& a, const TriangleBlock& b, float distance);
}  // namespace gpu_planning_scene::core
