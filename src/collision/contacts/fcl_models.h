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

/// Makes FCL's primitive for a sphere, cylinder or cone; null for any other shape.
FclGeometry makeFclRound(const Shape& shape);

/// Makes the same geometry as MoveIt: FCL's primitive for a sphere, cylinder, cone or box, and a tree of OBBRSS volumes
/// over a mesh. FCL reports contacts of whole faces for its own box, but not for a mesh of a box.
FclGeometry makeFclSolid(const Shape& shape, const Tessellation& tessellation);
}  // namespace gpu_planning_scene::core
