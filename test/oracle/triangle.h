#pragma once

#include <array>

#include "oracle/quad.h"

namespace gpu_planning_scene::core::oracle
{
/// A triangle with what its distances need. One without area, or thinner than 1e-25 of its longest edge, has no face:
/// only its edges count, which is as far off as it is thin.
struct Triangle
{
  explicit Triangle(const std::array<Vector, 3>& vertices);

  std::array<Vector, 3> corners;
  bool has_face;
  Vector normal;                 ///< unit length
  std::array<Vector, 3> inward;  ///< of the edge from corner i: in the face, at right angles to the edge
};

/// Their distance; 0 where they meet. From `limit` up the answer is some lower bound of at least `limit`.
Quad distance(const Triangle& a, const Triangle& b, Quad limit);
}  // namespace gpu_planning_scene::core::oracle
