#pragma once

#include <cstdint>

namespace gpu_planning_scene::core
{
constexpr unsigned kBlockTriangles = 4;

/// The triangles of a leaf as floats, as a structure of arrays. Slots beyond `count` repeat a triangle.
struct alignas(16) TriangleBlock
{
  float corners[3][3][kBlockTriangles];  ///< [i][k]: coordinate k of corner i
  std::uint32_t first;                   ///< the number of the leaf's first triangle in its tree
  std::uint32_t count;                   ///< 1 to kBlockTriangles
};

/// Tests each triangle of `a` against each triangle of `b`, in the same frame, by possible separating axes: the line
/// of their centres, both normals, and the products of their edges (e.g. Ericson, "Real-Time Collision Detection",
/// 2005, section 5.2). Bit kBlockTriangles * j + i of the result is 0 only if triangle i of `a` and triangle j of `b`
/// are farther apart than `distance`, provided that `distance` includes the rounding errors of
/// docs/error_bounds.md, "Triangles of wide trees". Thread-safe.
using NearTrianglesTest = unsigned (*)(const TriangleBlock& a, const TriangleBlock& b, float distance);
}  // namespace gpu_planning_scene::core
