#pragma once

#include <array>

#include <Eigen/Geometry>

namespace gpu_planning_scene
{
using Triangle = std::array<Eigen::Vector3d, 3>;

/// Where double rounding leaves it open whether two things touch, a distance up to this one counts as touching, so that
/// rounding does not lose a contact. It lies inside the 1e-9 m in which the contract leaves the answer free.
constexpr double kContactTolerance = 1e-10;  // metres

/// Whether two closed triangles have a point in common; touching counts. Triangles may be coplanar, or degenerate to a
/// segment or a point. Right where the triangles overlap or are apart by more than rounding; in between, distance
/// decides.
bool trianglesMeet(const Triangle& a, const Triangle& b);

/// Whether the distance of two closed triangles is at most `margin`.
bool trianglesWithin(const Triangle& a, const Triangle& b, double margin);

/// The point of a closed triangle, possibly degenerate, that is nearest to `point`.
Eigen::Vector3d nearestPoint(const Triangle& triangle, const Eigen::Vector3d& point);
}  // namespace gpu_planning_scene
