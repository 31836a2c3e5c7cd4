#pragma once

#include <memory>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

class btConvexShape;
class btTransform;

namespace gpu_planning_scene::core
{
/// What Bullet's hull of a mesh is made of: the hull is the same but for Bullet's rounding of its corners. GJK looks at
/// every point.
enum class HullPoints
{
  AllVertices,
  Corners
};

/// The shape in Bullet: a mesh as its convex hull, a primitive as Bullet's own, without a margin that would round its
/// corners. Throws Error for a half-space.
std::shared_ptr<btConvexShape> bulletShape(const Shape& shape, HullPoints points);

btTransform bulletPose(const Eigen::Isometry3d& pose);
}  // namespace gpu_planning_scene::core
