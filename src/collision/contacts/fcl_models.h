#pragma once

#include <memory>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace fcl
{
template <typename S>
class CollisionGeometry;
}

namespace gpu_planning_scene::core
{
/// Bounding volumes of FCL's trees.
enum class FclTree
{
  Obbrss,  ///< FCL's own choice, MoveIt's
  Obb,     ///< as in RAPID
  Aabb,    ///< not oriented: see FclMovedTree
  Kios,
  Kdop24  ///< not oriented
};

inline bool isOriented(FclTree tree)
{
  return tree != FclTree::Aabb && tree != FclTree::Kdop24;
}

using FclGeometry = std::shared_ptr<fcl::CollisionGeometry<double>>;

/// Spheres, cylinders and cones as FCL's shapes, all else as a tree over the tessellation.
FclGeometry makeFclGeometry(const Shape& shape, const Tessellation& tessellation, FclTree tree);

/// As MoveIt has them: boxes as FCL's boxes too, which tell contacts as those of whole faces; meshes as OBBRSS trees.
FclGeometry makeFclSolid(const Shape& shape, const Tessellation& tessellation);

/// A tree of volumes that are not oriented, which has to be fitted anew for each pose. FCL would build it anew for each
/// query, unless it lies in the planning frame already, as it does here. Not thread-safe.
class FclMovedTree
{
 public:
  virtual ~FclMovedTree() = default;
  /// In the planning frame; the mesh is at `pose`.
  virtual const fcl::CollisionGeometry<double>* at(const Eigen::Isometry3d& pose) = 0;
};

/// Null for what needs no such tree: oriented volumes, and primitives that FCL knows.
std::shared_ptr<FclMovedTree> makeFclMovedTree(const Shape& shape, const Tessellation& tessellation, FclTree tree);
}  // namespace gpu_planning_scene::core
