#pragma once

#include <array>
#include <variant>

#include "gpu_planning_scene/shapes.h"
#include "oracle/quad.h"

namespace gpu_planning_scene::core::oracle
{
/// The corners of a triangle as a convex set, in the frame of what it is compared with.
struct Corners
{
  std::array<Vector, 3> corners;
};

/// The convex sets that a distance is asked of. A sphere is its centre, with the radius taken off the distance.
using Convex = std::variant<Box, Sphere, Cylinder, Cone, Corners>;

/// The true distance lies between the two.
struct Bounds
{
  Quad lower;
  Quad upper;
};

/// The distance of two convex sets, by the algorithm of Gilbert, Johnson and Keerthi (1988): `upper` is the distance of
/// two points of the sets (0 for a common point), `lower` that of two parallel planes that have them on either side.
/// Ends where they differ by less than kAccuracy, or the lower is above `enough`, or the upper at most `required`.
/// Throws std::logic_error if it does not get there.
Bounds convexDistance(const Convex& a, const Motion& pose_a, const Convex& b, const Motion& pose_b, Quad required,
                      Quad enough);

/// The farthest point in a direction of any length but 0, of the true shape (not only the centre of a sphere).
Vector farthestPoint(const Convex& convex, const Vector& direction);
}  // namespace gpu_planning_scene::core::oracle
