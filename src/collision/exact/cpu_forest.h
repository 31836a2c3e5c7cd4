#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/forest.h"
#include "collision/geometry/components.h"
#include "collision/geometry/oriented_box.h"
#include "collision/geometry/triangle_pair.h"
#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// A node of a shape's tree: two cache lines, so that all of it is at hand where one is looked at.
struct alignas(64) CpuNode
{
  OrientedBox box;      ///< holds the triangles below the node
  std::uint32_t first;  ///< inner node: its children are nodes first and first + 1; leaf: its first triangle
  std::uint32_t count;  ///< 0: inner node; otherwise the number of a leaf's triangles

  bool isLeaf() const { return count != 0; }
};
static_assert(sizeof(CpuNode) == 128, "two cache lines");

/// A shape's tree with what the CPU's queries want to know of it, laid out for these. Immutable.
struct CpuTree
{
  Shape shape;
  bool mesh;
  Eigen::Vector3d center;  ///< of a box along the frame's axes that holds the shape, not only its tessellation
  Eigen::Vector3d half;
  OrientedBox box;                   ///< holds the shape as well
  MeshComponents parts;              ///< of a mesh
  Eigen::AlignedBox3d solid_bounds;  ///< of the closed components together; empty if there are none

  std::vector<CpuNode> nodes;              ///< node 0 is the root; children come after their parents
  std::vector<Triangle> triangles;         ///< in the order of the leaves, which index them
  std::vector<std::uint8_t> bounds_solid;  ///< one per triangle: 1 if it is one of a closed component
};

/// The trees of a collision problem. Immutable.
class CpuForest
{
 public:
  CpuForest() = default;
  /// `forest` holds a valid tree for each of the problem's trees.
  CpuForest(const CollisionProblem& problem, const Forest& forest);

  /// Trees that `previous` has, by their mesh and shape, are taken from there. `build` makes the others: a valid tree
  /// for each of the given tessellations.
  using Build = std::function<Forest(const std::vector<Tessellation>& shapes)>;
  CpuForest(const CollisionProblem& problem, const CpuForest& previous, const Build& build);

  const CpuTree& tree(std::uint32_t number) const { return *trees_[number]; }

 private:
  std::vector<std::shared_ptr<const CpuTree>> trees_;
  std::vector<Tessellation> shapes_;  // of each tree
};
}  // namespace gpu_planning_scene::core
