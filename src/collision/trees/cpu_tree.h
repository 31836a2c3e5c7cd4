#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/geometry/oriented_box.h"
#include "collision/geometry/triangle_pair.h"
#include "collision/trees/forest.h"
#include "collision/trees/wide_tree.h"
#include "gpu_planning_scene/shapes.h"
#include "gpu_planning_scene/solids.h"

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

/// Whether a traversal opens the first node of a pair rather than the second. It opens the larger node, unless this
/// node is a leaf. At most one of the two may be a leaf.
inline bool opensFirst(const CpuNode& a, const CpuNode& b)
{
  return b.isLeaf() || (!a.isLeaf() && a.box.half.squaredNorm() >= b.box.half.squaredNorm());
}

/// A shape's tree in the layout for the CPU's queries, with the shape's bounds and components. Immutable.
struct CpuTree
{
  Shape shape;
  bool mesh;
  Eigen::Vector3d center;  ///< centre of an axis-aligned box that contains the exact shape, not only its tessellation
  Eigen::Vector3d half;
  OrientedBox box;                         ///< oriented box that contains the exact shape
  std::shared_ptr<const SolidMesh> solid;  ///< components and roles of the triangles, meshes only
  Eigen::AlignedBox3d solid_bounds;        ///< bounds of all components with a solid; empty if there are none

  std::vector<CpuNode> nodes;       ///< node 0 is the root; children come after their parents
  std::vector<Triangle> triangles;  ///< in the order of the leaves; a leaf's `first` and `count` index them
  WideTree wide;                    ///< the same tree for tests of eight boxes at a time; meshes only
  std::vector<TriangleRole> roles;  ///< one per triangle; meshes only
};

/// The connected components of a mesh; none for a primitive.
const std::vector<Component>& componentsOf(const CpuTree& tree);

/// The tree of a shape, over its triangles: tree `number` of `forest`, which must be valid for them.
std::shared_ptr<const CpuTree> makeCpuTree(const Shape& shape, const Tessellation& tessellation, const Forest& forest,
                                           std::size_t number);

/// The tree of a shape. All checkers of the process share trees: if the tree of an equal shape is in use, the function
/// returns that tree; otherwise it builds a tree. Equal shapes are the same mesh, or primitives of the same kind and
/// dimensions. `shape` must not be a half-space. Thread-safe.
std::shared_ptr<const CpuTree> cpuTreeOf(const Shape& shape, const Tessellation& tessellation);

/// The tree of a primitive without nodes and triangles: enough for CpuShapePair, pairClearance and boundsOf, which test
/// the solid itself. It costs no tessellation. `solid` must not be a mesh or a half-space.
std::shared_ptr<const CpuTree> makeSolidTree(const Shape& solid);
}  // namespace gpu_planning_scene::core
