#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core::literature
{
/// A triangle of a hull: indices of points, counterclockwise from outside, and its plane normal . x = offset.
struct HullFacet
{
  std::array<std::uint32_t, 3> corners;
  Eigen::Vector3d normal;  ///< unit length, outward
  double offset;
};

struct ConvexHull
{
  std::vector<std::uint32_t> vertices;  ///< indices of points
  std::vector<HullFacet> facets;        ///< none if the points lie in a plane
  double area = 0.0;                    ///< of a flat hull: of one side
};

/// The convex hull of points, in double arithmetic. Points within `tolerance` of the hull of the others may be left
/// out. If rounding errors stop the algorithm, all points are vertices, and there are no facets.
ConvexHull convexHull(const std::vector<Eigen::Vector3d>& points, double tolerance);
}  // namespace gpu_planning_scene::core::literature
