#include "collision/geometry/precise_distance.h"

#include <algorithm>

#include <boost/multiprecision/cpp_bin_float.hpp>

// The least distance between two triangles whose edges do not pierce each other is the least distance between a vertex
// and a triangle or between two edges (Ericson, "Real-Time Collision Detection", 2005, 5.1). All of these distances are
// computed in quadruple precision.
namespace gpu_planning_scene::core
{
namespace
{
// No expression templates: their proxies refer to temporaries.
using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;

struct Vector
{
  Quad x;
  Quad y;
  Quad z;
};

Vector operator+(const Vector& a, const Vector& b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vector operator-(const Vector& a, const Vector& b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vector operator*(const Quad& factor, const Vector& a)
{
  return {factor * a.x, factor * a.y, factor * a.z};
}
Quad dot(const Vector& a, const Vector& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vector cross(const Vector& a, const Vector& b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

using PreciseTriangle = std::array<Vector, 3>;

/// The quotient, clamped to [0, 1]: the parameter of the point of a segment that is nearest to a point.
Quad clampedRatio(const Quad& numerator, const Quad& denominator)
{
  if (numerator <= 0 || denominator <= 0)
    return 0;
  return numerator >= denominator ? Quad(1) : Quad(numerator / denominator);
}

Quad squaredDistanceToSegment(const Vector& start, const Vector& end, const Vector& point)
{
  const Vector step = end - start;
  const Vector difference = start + clampedRatio(dot(point - start, step), dot(step, step)) * step - point;
  return dot(difference, difference);
}

/// The smaller of `best` and the squared distance of two segments, if the nearest points are inside both segments;
/// otherwise `best`. `best` must already include the distances of the segments' ends.
Quad leastOfSegments(const Vector& p0, const Vector& p1, const Vector& q0, const Vector& q1, const Quad& best)
{
  const Vector u = p1 - p0;
  const Vector v = q1 - q0;
  const Vector w = p0 - q0;
  const Vector n = cross(u, v);
  const Quad nn = dot(n, n);
  const Quad s = dot(cross(v, w), n);
  const Quad t = dot(cross(u, w), n);
  if (nn == 0 || s < 0 || s > nn || t < 0 || t > nn)
    return best;
  const Vector difference = w + Quad(s / nn) * u - Quad(t / nn) * v;
  return std::min(best, dot(difference, difference));
}

Quad squaredDistanceToTriangle(const PreciseTriangle& triangle, const Vector& point)
{
  const Vector ab = triangle[1] - triangle[0];
  const Vector ac = triangle[2] - triangle[0];
  const Vector n = cross(ab, ac);
  const Quad nn = dot(n, n);
  Quad best = squaredDistanceToSegment(triangle[0], triangle[1], point);
  best = std::min(best, squaredDistanceToSegment(triangle[1], triangle[2], point));
  best = std::min(best, squaredDistanceToSegment(triangle[2], triangle[0], point));
  const Vector ap = point - triangle[0];
  const Quad v = dot(cross(ap, ac), n);
  const Quad w = dot(cross(ab, ap), n);
  if (nn > 0 && v >= 0 && w >= 0 && v + w <= nn)
  {
    const Vector difference = Quad(v / nn) * ab + Quad(w / nn) * ac - ap;
    best = std::min(best, dot(difference, difference));
  }
  return best;
}

Vector precise(const Eigen::Vector3d& p)
{
  return {Quad(p.x()), Quad(p.y()), Quad(p.z())};
}

PreciseTriangle precise(const Triangle& triangle)
{
  return {precise(triangle[0]), precise(triangle[1]), precise(triangle[2])};
}
}  // namespace

double preciseDistance(const Triangle& a, const Triangle& b)
{
  Triangle first = sortedTriangle(a);
  Triangle second = sortedTriangle(b);
  if (precedes(second, first))
    std::swap(first, second);
  const PreciseTriangle p = precise(first);
  const PreciseTriangle q = precise(second);
  Quad best = squaredDistanceToTriangle(p, q[0]);
  for (std::size_t i = 0; i < 3; ++i)
  {
    best = std::min(best, squaredDistanceToTriangle(p, q[i]));
    best = std::min(best, squaredDistanceToTriangle(q, p[i]));
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      best = leastOfSegments(p[i], p[(i + 1) % 3], q[j], q[(j + 1) % 3], best);
  return static_cast<double>(sqrt(best));
}

double preciseDistance(const Triangle& triangle, const Eigen::Vector3d& point)
{
  const Quad squared = squaredDistanceToTriangle(precise(sortedTriangle(triangle)), precise(point));
  return static_cast<double>(sqrt(squared));
}
}  // namespace gpu_planning_scene::core
