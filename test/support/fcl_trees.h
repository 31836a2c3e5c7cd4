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
using FclGeometry = std::shared_ptr<fcl::CollisionGeometry<double>>;

/// Bounding volumes of FCL's trees.
enum class FclTree
{
  Obbrss,  ///< the default of FCL and MoveIt
  Obb,     ///< as in RAPID (Gottschalk 1996)
  Aabb,    ///< not oriented, see FclMovedTree
  Kios,
  Kdop24  ///< not oriented
};

/// Makes FCL's primitive for a sphere, cylinder or cone, and a tree over the tessellation for any other shape.
FclGeometry makeFclGeometry(const Shape& shape, const Tessellation& tessellation, FclTree tree);

/// A tree of bounding volumes that are not oriented. It must be refitted for each pose. FCL would rebuild it for each
/// query unless its vertices are already in the planning frame; this class keeps them there. Not thread-safe.
class FclMovedTree
{
 public:
  virtual ~FclMovedTree() = default;
  /// The tree in the planning frame, for a mesh at `pose`.
  virtual const fcl::CollisionGeometry<double>* at(const Eigen::Isometry3d& pose) = 0;
};

/// Makes such a tree. Null if none is needed: for oriented volumes, and for FCL's primitives.
std::shared_ptr<FclMovedTree> makeFclMovedTree(const Shape& shape, const Tessellation& tessellation, FclTree tree);
}  // namespace gpu_planning_scene::core
