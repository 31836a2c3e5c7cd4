#include "oracle/triangle.h"

#include <algorithm>

namespace gpu_planning_scene::core::oracle
{
namespace
{
Quad clampToUnit(Quad value)
{
  return value < 0 ? Quad(0) : value > 1 ? Quad(1) : value;
}

Vector nearestOnSegment(const Vector& p, const Vector& q, const Vector& point)
{
  const Vector along = q - p;
  const Quad squared = squaredLength(along);
  return squared > 0 ? p + clampToUnit(dot(point - p, along) / squared) * along : p;
}

/// The squared distance of two segments. If the common perpendicular of the lines meets both segments, its foot points
/// are nearest. Otherwise the distance is the distance of an end point from the other segment. Every candidate is the
/// squared distance of two points of the segments. So rounding in the choice of a foot point only matters between
/// nearly equal distances.
Quad squaredDistance(const Vector& p, const Vector& q, const Vector& r, const Vector& s)
{
  Quad best = squaredLength(p - nearestOnSegment(r, s, p));
  best = std::min(best, squaredLength(q - nearestOnSegment(r, s, q)));
  best = std::min(best, squaredLength(r - nearestOnSegment(p, q, r)));
  best = std::min(best, squaredLength(s - nearestOnSegment(p, q, s)));
  const Vector u = q - p;
  const Vector v = s - r;
  const Vector w = r - p;
  const Vector normal = cross(u, v);
  const Quad squared = squaredLength(normal);
  if (squared > 0)
  {
    const Quad on_first = dot(cross(w, v), normal) / squared;
    if (on_first > 0 && on_first < 1)
    {
      const Vector foot = p + on_first * u;
      best = std::min(best, squaredLength(foot - nearestOnSegment(r, s, foot)));
    }
  }
  return best;
}

/// Whether the projection of a point along the normal onto the triangle's plane is in the triangle.
bool aboveFace(const Triangle& triangle, const Vector& point)
{
  for (int i = 0; i < 3; ++i)
    if (dot(triangle.inward[i], point - triangle.corners[i]) < 0)
      return false;
  return true;
}

std::array<Quad, 3> heights(const Triangle& plane, const Triangle& other)
{
  std::array<Quad, 3> result;
  for (int i = 0; i < 3; ++i)
    result[i] = dot(plane.normal, other.corners[i] - plane.corners[0]);
  return result;
}

/// Whether all corners are on one side of the plane, at least `limit` away from it.
bool apartBy(const std::array<Quad, 3>& heights, Quad limit)
{
  const auto [least, most] = std::minmax({heights[0], heights[1], heights[2]});
  return limit > 0 && (least >= limit || most <= -limit);
}

/// Whether an edge of `other` crosses `face`. `heights`: of the corners of `other` above `face`.
bool pierced(const Triangle& face, const Triangle& other, const std::array<Quad, 3>& heights)
{
  for (int i = 0; i < 3; ++i)
  {
    const int k = (i + 1) % 3;
    if ((heights[i] < 0) == (heights[k] < 0))
      continue;
    const Quad at = heights[i] / (heights[i] - heights[k]);
    if (aboveFace(face, other.corners[i] + at * (other.corners[k] - other.corners[i])))
      return true;
  }
  return false;
}

/// The smallest distance from a corner of `other` to the plane of `face`, for corners whose foot point is in the face.
Quad leastHeight(const Triangle& face, const Triangle& other, const std::array<Quad, 3>& heights, Quad best)
{
  for (int i = 0; i < 3; ++i)
    if (abs(heights[i]) < best && aboveFace(face, other.corners[i]))
      best = abs(heights[i]);
  return best;
}

/// The vector from a segment to another one, between their nearest points; inexact for nearly parallel segments.
Eigen::Vector3d between(const Eigen::Vector3d& p, const Eigen::Vector3d& u, const Eigen::Vector3d& r,
                        const Eigen::Vector3d& v)
{
  const auto share = [](double numerator, double denominator)
  { return denominator > 0.0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0; };
  const Eigen::Vector3d w = p - r;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  double on_first = share(uv * v.dot(w) - vv * u.dot(w), uu * vv - uv * uv);
  const double on_second = share(uv * on_first + v.dot(w), vv);
  on_first = share(uv * on_second - u.dot(w), uu);
  return r + on_second * v - p - on_first * u;
}

/// The distance of two planes perpendicular to `direction` between which there is no point of the triangles. Negative
/// if the projections of the triangles onto `direction` overlap.
double gapAlong(const Eigen::Vector3d& direction, const TriangleCorners& a, const TriangleCorners& b)
{
  const double length = direction.norm();
  if (!(length > 1e-140))
    return 0.0;  // its square underflows, so the length is inexact
  double least_a = direction.dot(a[0]);
  double most_a = least_a;
  double least_b = direction.dot(b[0]);
  double most_b = least_b;
  for (int i = 1; i < 3; ++i)
  {
    const double along_a = direction.dot(a[i]);
    const double along_b = direction.dot(b[i]);
    least_a = std::min(least_a, along_a);
    most_a = std::max(most_a, along_a);
    least_b = std::min(least_b, along_b);
    most_b = std::max(most_b, along_b);
  }
  return std::max(least_b - most_a, least_a - most_b) / length;
}
}  // namespace

double leastDistance(const TriangleCorners& a, const TriangleCorners& b)
{
  // Any direction gives a lower bound. Those of the two normals and of the nearest edges give the distance itself.
  Eigen::Vector3d shortest = b[0] - a[0];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
    {
      const Eigen::Vector3d vector = between(a[i], a[(i + 1) % 3] - a[i], b[k], b[(k + 1) % 3] - b[k]);
      if (vector.squaredNorm() < shortest.squaredNorm())
        shortest = vector;
    }
  const double gap = std::max({gapAlong(shortest, a, b), gapAlong((a[1] - a[0]).cross(a[2] - a[0]), a, b),
                               gapAlong((b[1] - b[0]).cross(b[2] - b[0]), a, b)});
  const auto size = [](const TriangleCorners& t) { return t[0].norm() + t[1].norm() + t[2].norm(); };
  return gap - 1e-14 * (size(a) + size(b));
}

Triangle::Triangle(const std::array<Vector, 3>& vertices) : corners(vertices)
{
  const std::array<Vector, 3> edges = {corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  const Quad longest = std::max({squaredLength(edges[0]), squaredLength(edges[1]), squaredLength(edges[2])});
  normal = cross(edges[0], edges[1]);
  const Quad doubled_area = length(normal);
  has_face = doubled_area > Quad(1e-25) * longest;
  if (!has_face)
    return;
  normal = (1 / doubled_area) * normal;
  for (int i = 0; i < 3; ++i)
    inward[i] = cross(normal, edges[i]);
}

Quad distance(const Triangle& a, const Triangle& b, Quad limit)
{
  std::array<Quad, 3> b_above_a;
  std::array<Quad, 3> a_above_b;
  if (a.has_face)
  {
    b_above_a = heights(a, b);
    if (apartBy(b_above_a, limit))
      return limit;
    if (pierced(a, b, b_above_a))
      return 0;
  }
  if (b.has_face)
  {
    a_above_b = heights(b, a);
    if (apartBy(a_above_b, limit))
      return limit;
    if (pierced(b, a, a_above_b))
      return 0;
  }
  Quad squared = squaredLength(a.corners[0] - b.corners[0]);
  for (int i = 0; i < 3; ++i)
  {
    for (int k = 0; k < 3; ++k)
      squared = std::min(squared,
                         squaredDistance(a.corners[i], a.corners[(i + 1) % 3], b.corners[k], b.corners[(k + 1) % 3]));
  }
  Quad best = sqrt(squared);
  if (a.has_face)
    best = leastHeight(a, b, b_above_a, best);
  if (b.has_face)
    best = leastHeight(b, a, a_above_b, best);
  return best;
}
}  // namespace gpu_planning_scene::core::oracle
