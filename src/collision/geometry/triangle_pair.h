#pragma once

#include <array>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
using Triangle = std::array<Eigen::Vector3d, 3>;

/// The canonical decision: shapes with a required distance v collide if their distance is at most v + kSlack. The
/// contract allows both answers for distances in (v, v + 1e-9 m], and this threshold lies in the middle. So errors
/// below 0.5e-9 m do not violate the contract. The rounding of poses and of the distances computed here stays below
/// 1e-10 m within a kilometre.
constexpr double kSlack = 0.5e-9;  // metres

/// Whether two closed triangles with a required distance collide, i.e. whether their distance is at most `required` +
/// kSlack. The triangles may be coplanar, or degenerate to a segment or a point. The result does not depend on the
/// order of the vertices and of the triangles.
bool trianglesWithin(const Triangle& a, const Triangle& b, double required);

/// The distance of two closed triangles in double arithmetic, if no edge of one passes through the inside of the other.
/// It is usually accurate to 1e-12 m; for slivers there is no bound.
double outlineDistance(const Triangle& a, const Triangle& b);

/// The point of a closed triangle that is nearest to `point`; the triangle may be degenerate. The error is about 1e-16
/// times the squared size of the triangle, divided by the distance. The point lies in the triangle up to the rounding
/// of its coordinates.
Eigen::Vector3d nearestPoint(const Triangle& triangle, const Eigen::Vector3d& point);

/// The triangle with its vertices in lexicographic order, which is the same for all orders of the given vertices.
Triangle sortedTriangle(const Triangle& triangle);

/// Lexicographic order of two sorted triangles.
bool precedes(const Triangle& a, const Triangle& b);
}  // namespace gpu_planning_scene::core
