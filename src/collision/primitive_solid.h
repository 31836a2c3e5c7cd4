#pragma once

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"
#include "triangle_pair.h"

namespace gpu_planning_scene
{
/// Primitives as what they are: solids with their true, curved surface. All shapes here are primitives, not meshes, and
/// everything is in the shape's frame. Touching counts; distances up to about kContactTolerance count as touching.

bool isMesh(const Shape& shape);

/// Of the smallest box that is centred at the origin and contains the solid.
Eigen::Vector3d halfExtents(const Shape& solid);

/// How far a point is from the solid; 0 inside.
double distanceToSolid(const Shape& solid, const Eigen::Vector3d& point);

/// Whether a closed triangle and the solid have a point in common: also where the triangle lies inside.
bool triangleMeetsSolid(const Triangle& triangle, const Shape& solid);
}  // namespace gpu_planning_scene
