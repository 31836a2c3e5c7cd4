#pragma once

#include <Eigen/Geometry>

#include "collision/geometry/convex_pair.h"
#include "collision/geometry/triangle_pair.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Predicates of primitives with their exact surface, without a tessellation. `solid` is a box, sphere, cylinder or
/// cone. The answers are canonical decisions (see kSlack). They use distances that are accurate to about 1e-14 times
/// the sizes of the shapes, i.e. 1e-12 m for shapes of up to 100 m.

bool isMesh(const Shape& shape);

/// Half lengths of the smallest axis-aligned box that is centred at the origin and contains the solid.
Eigen::Vector3d halfExtents(const Shape& solid);

/// The vector from the nearest point of the solid to a point, in the solid's frame; 0 inside.
Eigen::Vector3d vectorFromSolid(const Shape& solid, const Eigen::Vector3d& point);

/// The distance of a point from the solid, in the solid's frame; 0 inside.
double distanceToSolid(const Shape& solid, const Eigen::Vector3d& point);

/// The distance of a point inside the solid from its surface, in the solid's frame; 0 outside.
double depthInSolid(const Shape& solid, const Eigen::Vector3d& point);

/// Distances as convexDistance() computes them: of a closed triangle in the solid's frame from the solid, and of two
/// solids, where `b_in_a` is the pose of `b` in the frame of `a`; 0 if they intersect.
double distanceToSolid(const Shape& solid, const Triangle& triangle);
double distanceOfSolids(const Shape& a, const Shape& b, const Eigen::Isometry3d& b_in_a);

/// A point of the solid that is farthest along a direction, in the solid's frame.
Eigen::Vector3d farthestOfSolid(const Shape& solid, const Eigen::Vector3d& direction);

/// The largest coordinate of the solid along a direction of unit length, in the solid's frame.
double reachAlong(const Shape& solid, const Eigen::Vector3d& direction);

/// Whether a closed triangle and a solid with a required distance collide. The triangle is in the solid's frame. A
/// triangle inside the solid collides. The result does not depend on the order of the vertices. `axis`: from an earlier
/// triangle of the same mesh, see convexWithin(); null: none.
bool triangleWithinSolid(const Triangle& triangle, const Shape& solid, double required, SeparatingAxis* axis = nullptr);

/// Whether two solids with a required distance collide; `b_in_a` is the pose of `b` in the frame of `a`.
bool solidsWithin(const Shape& a, const Shape& b, const Eigen::Isometry3d& b_in_a, double required);
}  // namespace gpu_planning_scene::core
