#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <geometric_shapes/shapes.h>

#include "collision/trees/cpu_tree.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::detector
{
enum class ShapeKind
{
  Solid,      ///< a box, sphere, cylinder, cone or mesh
  HalfSpace,  ///< a plane, with everything behind it
  Octree,     ///< the occupied leaves of an octree
  Empty,      ///< a mesh without triangles, or a point; it collides with nothing
  Faulty      ///< cannot be checked; it collides with everything that it is checked against
};

/// A shape of MoveIt, converted for the exact tests. Immutable, but for the content of an octree: MoveIt changes it in
/// place, so it is read anew in each check. Thread-safe.
class CollisionShape
{
 public:
  /// `scale`: as in MoveIt, a factor about the shape's origin; about the mean of the vertices for a mesh. Does not
  /// throw for a shape that cannot be checked: its kind is Faulty, and fault() tells why.
  CollisionShape(const shapes::Shape& shape, double scale, const std::string& name);
  /// A cube: a leaf of an octree.
  explicit CollisionShape(double side);
  /// A shape that cannot be checked.
  static const CollisionShape& faulty();

  ShapeKind kind() const { return kind_; }
  const std::string& fault() const { return fault_; }
  /// Solids.
  const core::CpuTree& tree() const { return *tree_; }
  const std::shared_ptr<const core::CpuTree>& sharedTree() const { return tree_; }
  /// Half-spaces, in the shape's frame.
  const core::HalfSpace& halfSpace() const { return half_space_; }
  /// Octrees.
  const octomap::OcTree& octree() const { return *octree_; }
  /// Octrees: the cube of the leaves at a depth. A map that is loaded into an octree can change its resolution.
  std::shared_ptr<const CollisionShape> leaf(unsigned depth) const;

  /// Solids: see core::isConvexSolid. Computed when it is first used.
  bool isConvex() const;

 private:
  CollisionShape() = default;
  void convert(const shapes::Shape& shape, double scale, const std::string& name);
  void setSolid(core::Shape shape);

  ShapeKind kind_ = ShapeKind::Faulty;
  std::string fault_;
  std::shared_ptr<const core::CpuTree> tree_;
  core::HalfSpace half_space_{Eigen::Vector3d::UnitZ(), 0.0};
  std::shared_ptr<const octomap::OcTree> octree_;
  std::vector<std::shared_ptr<const CollisionShape>> leaves_;  // by depth; the root has depth 0
  double leaf_resolution_ = 0.0;                               // of leaves_
  mutable std::once_flag convexity_known_;
  mutable bool is_convex_ = false;
};

using CollisionShapePtr = std::shared_ptr<const CollisionShape>;

/// The conversion of a shape. All environments of the process share it, as long as the shape exists. Logs an error for
/// a faulty shape, once. `name`: the body, for messages.
CollisionShapePtr collisionShapeOf(const shapes::ShapeConstPtr& shape, double scale, const std::string& name);

/// Forgets conversions of shapes that no longer exist, unless most of them still do. Call it when a body is removed.
void forgetUnusedShapes();
}  // namespace gpu_planning_scene::detector
