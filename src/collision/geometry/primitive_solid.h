#pragma once

#include <Eigen/Geometry>

#include "collision/geometry/triangle_pair.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Primitives as what they are: solids with their true, curved surface. All shapes here are primitives, not meshes or
/// half-spaces. Answers are canonical decisions (see kSlack) on distances that are
/// right to about 1e-14 of the shapes' size, so to 1e-12 m for those of up to 100 m.

bool isMesh(const Shape& shape);

/// Of the smallest box that is centred at the origin and contains the solid.
Eigen::Vector3d halfExtents(const Shape& solid);

/// How far a point in the solid's frame is from it; 0 inside.
double distanceToSolid(const Shape& solid, const Eigen::Vector3d& point);

/// A point of the solid that is farthest along a direction, in its frame.
Eigen::Vector3d farthestOfSolid(const Shape& solid, const Eigen::Vector3d& direction);

/// The farthest that the solid reaches along a direction of unit length, in its frame.
double reachAlong(const Shape& solid, const Eigen::Vector3d& direction);

/// Whether a closed triangle, in the solid's frame, and the solid, with a required distance, collide: also where the
/// triangle lies inside. Does not depend on the order of the vertices.
bool triangleWithinSolid(const Triangle& triangle, const Shape& solid, double required);

/// Whether two solids with a required distance collide, `b` placed in the frame of `a`.
bool solidsWithin(const Shape& a, const Shape& b, const Eigen::Isometry3d& b_in_a, double required);
}  // namespace gpu_planning_scene::core
