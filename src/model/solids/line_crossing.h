#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
struct Line
{
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// How a line crosses a triangle.
struct LineCrossing
{
  enum Kind
  {
    None,
    NearBorder,  ///< too near to the border of the triangle to be sure
    Certain
  };

  Kind kind = None;
  double at = 0.0;  ///< Certain: where, in lengths of the direction from the origin of the line
  bool leaves_at_front = false;
};

/// Signed volumes of the tetrahedra between the line and the edges decide (A. Platis, T. Theoharis: Fast
/// ray-tetrahedron intersection using Pluecker coordinates. Journal of Graphics Tools 8(4), 2003).
inline LineCrossing crossing(const Line& line, const std::vector<Eigen::Vector3d>& points, const Corners& triangle)
{
  constexpr double kNearBorder = 1e-6;  // as a share of the triangle's area
  const Eigen::Vector3d a = points[triangle[0]] - line.origin;
  const Eigen::Vector3d b = points[triangle[1]] - line.origin;
  const Eigen::Vector3d c = points[triangle[2]] - line.origin;
  const Eigen::Vector3d weights(line.direction.dot(b.cross(c)), line.direction.dot(c.cross(a)),
                                line.direction.dot(a.cross(b)));
  const double sum = weights.sum();
  const double least = (sum < 0.0 ? -weights : weights).minCoeff();
  const double border = kNearBorder * weights.lpNorm<1>();
  if (least < -border)
    return {};
  if (!(least > border))
    return {LineCrossing::NearBorder};
  const Eigen::Vector3d point = weights[0] * a + weights[1] * b + weights[2] * c;
  return {LineCrossing::Certain, point.dot(line.direction) / (sum * line.direction.squaredNorm()), sum > 0.0};
}

/// The winding number of triangles without signed boundary at the origin of the line: the sum of the signed crossings
/// ahead of it. Empty if the line passes near the border of a triangle.
inline std::optional<int> windingNumber(const Line& line, const std::vector<Eigen::Vector3d>& points,
                                        const std::vector<Corners>& triangles)
{
  int winding = 0;
  for (const Corners& t : triangles)
  {
    const LineCrossing met = crossing(line, points, t);
    if (met.kind == LineCrossing::NearBorder)
      return std::nullopt;
    if (met.kind == LineCrossing::Certain && met.at > 0.0)
      winding += met.leaves_at_front ? 1 : -1;
  }
  return winding;
}
}  // namespace gpu_planning_scene::core
