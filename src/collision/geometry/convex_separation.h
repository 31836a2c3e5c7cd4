#pragma once

#include <limits>

#include <Eigen/Geometry>

#include "collision/geometry/convex_pair.h"

namespace gpu_planning_scene::core
{
/// How far two convex sets a and b overlap or are apart, along the direction that is best for their separation.
struct ConvexSeparation
{
  /// Unit vector from a to b.
  Eigen::Vector3d normal;
  /// The largest coordinate of a along the normal minus the least coordinate of b. Above 0: once b has moved along the
  /// normal by more than the depth, a plane separates the sets. Below 0: a plane separates them already, and -depth is
  /// their distance.
  double depth;
  /// Points of a and b. Their difference on_a - on_b is depth * normal, up to the accuracy of the depth.
  Eigen::Vector3d on_a;
  Eigen::Vector3d on_b;
  /// The least depth of all directions is not below this. It may be much less than the depth where curved surfaces, or
  /// meshes that approximate them, overlap in many directions by nearly the same depth. Minus infinity: nothing is
  /// known.
  double least_depth = -std::numeric_limits<double>::infinity();
};

/// The direction for which the depth is least: the penetration depth of sets that overlap, minus the distance of
/// others. The depth is exact for the normal, up to rounding. It exceeds the least depth of all directions by up to
/// 1e-9 times the sizes of the sets, and by more only if many directions are nearly as good: where sets that are
/// curved, or have many faces, overlap almost concentrically.
ConvexSeparation separationOf(const Convex& a, const Convex& b);

/// A point of both sets, up to 1e-11 times their sizes. If the sets are apart, the middle between their nearest points.
Eigen::Vector3d commonPoint(const Convex& a, const Convex& b);
}  // namespace gpu_planning_scene::core
