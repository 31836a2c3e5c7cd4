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
/// A node of a shape's tree. It fills two cache lines, so a visit loads nothing else.
struct alignas(64) CpuNode
{
  OrientedBox box;      ///< contains the triangles below the node
  std::uint32_t first;  ///< inner node: its children are nodes first and first + 1; leaf: its first triangle
  std::uint32_t count;  ///< 0: inner node; otherwise the number of a leaf's triangles

  bool isLeaf() const { return count != 0; }
};
static_assert(sizeof(CpuNode) == 128, "two cache lines");

/// A shape's tree in the layout for the CPU's queries, with the shape's bounds and components. Immutable.
struct CpuTree
{
  Shape shape;
  bool mesh;
  Eigen::Vector3d center;  ///< centre of an axis-aligned box that contains the exact shape, not only its tessellation
  Eigen::Vector3d half;
  OrientedBox box;                   ///< oriented box that contains the exact shape
  MeshComponents components;         ///< connected components, meshes only
  Eigen::AlignedBox3d solid_bounds;  ///< bounds of all closed components together; empty if there are none

  std::vector<CpuNode> nodes;              ///< node 0 is the root; children come after their parents
  std::vector<Triangle> triangles;         ///< in the order of the leaves; a leaf's `first` and `count` index them
  std::vector<std::uint8_t> bounds_solid;  ///< one per triangle: 1 if it belongs to a closed component
};

/// The trees of a collision problem. Immutable.
class CpuForest
{
 public:
  CpuForest() = default;
  /// `forest` must hold a valid tree for each of the problem's trees.
  CpuForest(const CollisionProblem& problem, const Forest& forest);

  /// Takes trees from `previous` if their mesh and shape are the same. `build` makes the other trees: it returns a
  /// valid tree for each given tessellation.
  using Build = std::function<Forest(const std::vector<Tessellation>& shapes)>;
  CpuForest(const CollisionProblem& problem, const CpuForest& previous, const Build& build);

  const CpuTree& tree(std::uint32_t number) const { return *trees_[number]; }

 private:
  std::vector<std::shared_ptr<const CpuTree>> trees_;
  std::vector<Tessellation> shapes_;  // tessellation of each tree
};
}  // namespace gpu_planning_scene::core
