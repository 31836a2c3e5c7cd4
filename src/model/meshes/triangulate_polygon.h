#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// Cuts a polygon into triangles along diagonals. `corners`: the outline, then the holes, one after the other.
/// `hole_starts`: the index of the first corner of each hole. Returns triangles of indices into `corners`, turning as
/// the outline does. Requires an outline of at least 3 corners.
///
/// - Each edge of the polygon is an edge of exactly one triangle, and no vertex is added. So neighbouring polygons
///   still share their edges. Exception: equal corners in a row count as one corner, if 3 corners remain.
/// - The triangles of a flat polygon cover exactly the polygon, concave or not.
/// - A polygon that crosses itself is covered too, and perhaps points around it: each point with a winding number other
///   than 0 lies in a triangle, because the winding number is the sum over the triangles.
/// - A polygon that is not flat is cut as its projection along an axis is; the axis is the one nearest to its normal.
///
/// Throws Error if a hole is not inside the outline.
std::vector<std::array<std::uint32_t, 3>> triangulatePolygon(const std::vector<Eigen::Vector3d>& corners,
                                                             const std::vector<std::uint32_t>& hole_starts = {});
}  // namespace gpu_planning_scene::core
