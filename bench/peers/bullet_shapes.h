#pragma once

#include <memory>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

class btConvexShape;
class btTransform;

namespace gpu_planning_scene::core
{
/// The points of Bullet's convex hull shape of a mesh. Both choices give the same hull, except that Bullet rounds the
/// coordinates of computed corners. GJK looks at every point, so fewer points are faster.
enum class HullPoints
{
  AllVertices,
  Corners
};

/// Converts a shape to Bullet: a mesh becomes its convex hull, a primitive becomes Bullet's own primitive. The margin
/// is 0, because a margin would round the corners. Throws Error for a half-space.
std::shared_ptr<btConvexShape> bulletShape(const Shape& shape, HullPoints points);

btTransform bulletPose(const Eigen::Isometry3d& pose);
}  // namespace gpu_planning_scene::core
