#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
constexpr std::uint32_t kLeafTriangles = 4;  // largest number of triangles in a leaf

/// A node of a bounding volume hierarchy over triangles, in the layout of the GPU's memory (two RGBA32UI texels). The
/// box is in the mesh's frame, in metres. It contains the double-precision vertices of its triangles.
struct Node
{
  std::array<float, 3> center;
  std::uint32_t first;  ///< inner node: the children are first and first + 1; leaf: index into leaf_triangles
  std::array<float, 3> half;
  std::uint32_t count;  ///< 0: inner node; otherwise the number of a leaf's triangles (at most kLeafTriangles)
};
static_assert(sizeof(Node) == 32, "two RGBA32UI texels");

inline Eigen::Vector3d centerOf(const Node& node)
{
  return {node.center[0], node.center[1], node.center[2]};
}
inline Eigen::Vector3d halfOf(const Node& node)
{
  return {node.half[0], node.half[1], node.half[2]};
}
inline Eigen::AlignedBox3d boundsOf(const Node& node)
{
  return {centerOf(node) - halfOf(node), centerOf(node) + halfOf(node)};
}

/// The trees of several meshes in one array of nodes. The array may contain further nodes. Triangles are numbered
/// across all meshes: triangle t of mesh m has the number first_triangle[m] + t.
struct Forest
{
  std::vector<Node> nodes;
  std::vector<std::uint32_t> roots;           ///< one per mesh
  std::vector<std::uint32_t> first_triangle;  ///< one per mesh
  std::vector<std::uint32_t> leaf_triangles;  ///< triangle numbers; a leaf has the entries first .. first + count - 1
};
}  // namespace gpu_planning_scene::core
