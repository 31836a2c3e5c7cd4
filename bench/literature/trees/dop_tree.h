#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "literature/trees/triangle_overlap.h"

namespace gpu_planning_scene::core::literature
{
/// The extent of a volume along kAxes fixed axes: the k-DOP with k = 2 kAxes.
template <std::size_t kAxes>
struct Slabs
{
  std::array<double, kAxes> lower;
  std::array<double, kAxes> upper;

  bool overlaps(const Slabs& other) const
  {
    for (std::size_t i = 0; i < kAxes; ++i)
      if (lower[i] > other.upper[i] || other.lower[i] > upper[i])
        return false;
    return true;
  }
};

template <std::size_t kAxes>
using DopAxes = std::array<Eigen::Vector3d, kAxes>;

/// x, y, z and the face diagonals of a cube. All components are -1, 0 or 1.
const DopAxes<9>& axesOf18Dop();
/// The directions of the 18-DOP, and three of the four space diagonals of a cube, as in FCL's 24-DOP. All have
/// length 1.
const DopAxes<12>& axesOf24Dop();

/// A tree of k-DOPs over the triangles of a mesh, in the mesh's frame. A leaf has one triangle. The centroids of a
/// node's triangles are divided at their mean, along the one of x, y and z in which they vary most.
template <std::size_t kAxes>
class DopTree
{
 public:
  struct Node
  {
    Slabs<kAxes> slabs;
    std::uint32_t child = 0;  ///< of two children, child and child + 1; 0: a leaf
    std::uint32_t triangle = 0;
  };

  DopTree(const Mesh& mesh, const DopAxes<kAxes>& axes);
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  void build(std::uint32_t node, std::uint32_t* begin, std::uint32_t* end, const DopAxes<kAxes>& axes);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};
}  // namespace gpu_planning_scene::core::literature
