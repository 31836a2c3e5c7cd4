#pragma once

#include "collision/geometry/triangle_pair.h"

namespace gpu_planning_scene::core
{
/// Distances in quadruple precision, for the few pairs that double arithmetic cannot decide. A call takes about 0.1 ms.
///
/// Error: consider two edges of length L at an angle theta. The parameters of their nearest points are quotients by
/// squared areas, so the points are wrong by up to about 2^-112 L / theta along the edges. The distances of the edges'
/// ends are candidates too. They do not have this error, but they may exceed the least distance by up to theta L. The
/// smaller of the two errors is largest at theta = 2^-56: 2^-56 L, or 1.4e-14 m for triangles of a kilometre. Slivers
/// are the same case.

/// The distance between two closed triangles. No edge of one triangle may pass through the inside of the other; see
/// edgePierces in triangle_pair.cpp. The result does not depend on the order of the vertices or of the triangles.
double preciseDistance(const Triangle& a, const Triangle& b);

/// The distance of a point from a closed triangle. The result does not depend on the order of the vertices.
double preciseDistance(const Triangle& triangle, const Eigen::Vector3d& point);
}  // namespace gpu_planning_scene::core
