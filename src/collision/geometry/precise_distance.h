#pragma once

#include "collision/geometry/triangle_pair.h"

namespace gpu_planning_scene::core
{
/// Distances in quadruple precision, for the few pairs that double arithmetic cannot decide: about 0.1 ms each.
///
/// Error: two edges of length L at an angle theta have nearest points with parameters that are quotients by squared
/// areas, so the points are off by up to about 2^-112 L / theta along the edges; the distances of the edges' ends,
/// which are candidates too and have no such error, miss the least one by at most theta L. The smaller of both is
/// largest at theta = 2^-56, where it is 2^-56 L: 1.4e-14 m for triangles of a kilometre. Slivers are the same case.

/// The distance of two closed triangles, of which no edge passes through the inside of the other: see edgePierces. Does
/// not depend on the order of the vertices or of the triangles.
double preciseDistance(const Triangle& a, const Triangle& b);

/// The distance of a point from a closed triangle. Does not depend on the order of the vertices.
double preciseDistance(const Triangle& triangle, const Eigen::Vector3d& point);
}  // namespace gpu_planning_scene::core
