#pragma once

#include <array>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
using Triangle = std::array<Eigen::Vector3d, 3>;

/// The canonical decision: shapes with a required distance v collide if their distance is at most v + kSlack. The
/// contract lets all answers pass for distances in (v, v + 1e-9 m], so errors of half of that change no answer that it
/// demands: rounding of poses and of the distances here, which are right to 1e-10 m within a kilometre, cannot.
constexpr double kSlack = 0.5e-9;  // metres

/// Whether two closed triangles with a required distance collide: their distance is at most `required` + kSlack (0:
/// they meet, or nearly). Triangles may be coplanar, or degenerate to a segment or a point. Does not depend on the
/// order of vertices and triangles.
bool trianglesWithin(const Triangle& a, const Triangle& b, double required);

/// The point of a closed triangle, possibly degenerate, that is nearest to `point`, to about 1e-16 times the square of
/// the triangle's size over the distance. It is in the triangle up to the rounding of its coordinates.
Eigen::Vector3d nearestPoint(const Triangle& triangle, const Eigen::Vector3d& point);

/// The triangle with its vertices in lexicographic order: the same for all orders of the vertices.
Triangle sortedTriangle(const Triangle& triangle);

/// Lexicographic order of sorted triangles.
bool precedes(const Triangle& a, const Triangle& b);
}  // namespace gpu_planning_scene::core
