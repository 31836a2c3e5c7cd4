#pragma once

#include <array>
#include <variant>

#include "gpu_planning_scene/shapes.h"
#include "oracle/quad.h"

namespace gpu_planning_scene::core::oracle
{
/// The corners of a triangle as a convex set, in the frame of the other convex set.
struct Corners
{
  std::array<Vector, 3> corners;
};

/// The convex sets whose distances are computed. A sphere is represented by its centre; its radius is subtracted from
/// the distance.
using Convex = std::variant<Box, Sphere, Cylinder, Cone, Corners>;

/// The true distance lies between `lower` and `upper`.
struct Bounds
{
  Quad lower;
  Quad upper;
};

/// The distance of two convex sets, by the algorithm of Gilbert, Johnson and Keerthi (1988). `upper` is the distance of
/// two points of the sets (0 for a common point). `lower` is the distance of two parallel planes between the sets. The
/// search ends when the bounds differ by less than kAccuracy, when `lower` is above `enough`, or when `upper` is at
/// most `required`. Throws std::logic_error if the search does not converge.
Bounds convexDistance(const Convex& a, const Motion& pose_a, const Convex& b, const Motion& pose_b, Quad required,
                      Quad enough);

/// The farthest point of the shape in a direction of any nonzero length. The radius of a sphere is included.
Vector farthestPoint(const Convex& convex, const Vector& direction);
}  // namespace gpu_planning_scene::core::oracle
