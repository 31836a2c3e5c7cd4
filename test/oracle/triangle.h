#pragma once

#include <array>

#include "oracle/quad.h"

namespace gpu_planning_scene::core::oracle
{
/// A triangle with the data for its distances. A triangle without area, or thinner than 1e-25 of its longest edge, has
/// no face: only its edges count. The error of this is at most the thickness.
struct Triangle
{
  explicit Triangle(const std::array<Vector, 3>& vertices);

  std::array<Vector, 3> corners;
  bool has_face;
  Vector normal;                 ///< unit length
  std::array<Vector, 3> inward;  ///< for the edge from corner i: in the plane of the face, perpendicular to the edge
};

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/// A lower bound of the distance of two triangles; it can be negative. It is computed in double and accounts for
/// rounding.
double leastDistance(const TriangleCorners& a, const TriangleCorners& b);

/// The distance of two triangles; 0 if they have a common point. If the distance is at least `limit`, the result is
/// some lower bound of at least `limit`.
Quad distance(const Triangle& a, const Triangle& b, Quad limit);
}  // namespace gpu_planning_scene::core::oracle
