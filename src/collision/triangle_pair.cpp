#include "triangle_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gpu_planning_scene
{
namespace
{
using Eigen::Vector3d;

/// A bound on the rounding error of the volume u x v . w of three differences of coordinates, by their largest
/// components: six products of three factors, each with less than eight roundings.
double volumeError(double u_size, double v_size, double w_size)
{
  return 6.0 * 8.0 * std::numeric_limits<double>::epsilon() * u_size * v_size * w_size;
}

/// 0 where rounding may have changed the sign.
int clearSign(double value, double error)
{
  return value > error ? 1 : value < -error ? -1 : 0;
}

/// Whether the projections of two triangles on an axis are so far apart that their distance exceeds the tolerance.
bool separates(const Vector3d& axis, const Triangle& p, const Triangle& q)
{
  const double p0 = axis.dot(p[0] - q[0]);
  const double p1 = axis.dot(p[1] - q[0]);
  const double p2 = axis.dot(p[2] - q[0]);
  const double q1 = axis.dot(q[1] - q[0]);
  const double q2 = axis.dot(q[2] - q[0]);
  const double gap =
      std::max(std::min({p0, p1, p2}) - std::max({0.0, q1, q2}), std::min({0.0, q1, q2}) - std::max({p0, p1, p2}));
  // Twice the tolerance leaves room for the rounding of the projections.
  return gap > 2.0 * kContactTolerance * axis.norm();
}

double squaredDistanceOfSegments(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0, const Vector3d& q1)
{
  const Vector3d u = p1 - p0;
  const Vector3d v = q1 - q0;
  const Vector3d w = p0 - q0;
  const auto clamp_to_segment = [](double numerator, double denominator)
  { return denominator > 0.0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0; };
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  // The nearest points are inside both segments, or one of them is an end.
  double best = (w + clamp_to_segment(-w.dot(u), uu) * u).squaredNorm();
  best = std::min(best, (p0 + clamp_to_segment((q1 - p0).dot(u), uu) * u - q1).squaredNorm());
  best = std::min(best, (w - clamp_to_segment(w.dot(v), vv) * v).squaredNorm());
  best = std::min(best, (q0 + clamp_to_segment((p1 - q0).dot(v), vv) * v - p1).squaredNorm());
  const Vector3d n = u.cross(v);
  const double nn = n.squaredNorm();
  const double s = v.cross(w).dot(n);
  const double t = u.cross(w).dot(n);
  if (nn > 0.0 && s >= 0.0 && s <= nn && t >= 0.0 && t <= nn)
  {
    best = std::min(best, (w + (s / nn) * u - (t / nn) * v).squaredNorm());
  }
  return best;
}

/// Of two triangles of which no edge of one passes through the inside of the other.
double squaredDistanceOfOutlines(const Triangle& a, const Triangle& b)
{
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
  {
    best = std::min(best, (nearestPoint(a, b[i]) - b[i]).squaredNorm());
    best = std::min(best, (nearestPoint(b, a[i]) - a[i]).squaredNorm());
    for (int j = 0; j < 3; ++j)
    {
      best = std::min(best, squaredDistanceOfSegments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    }
  }
  return best;
}

enum class Verdict
{
  Hit,
  Apart,
  Undecided
};

/// Decides what is clear: apart if an axis separates them by more than the tolerance; a hit by the signs of volumes:
/// those of one triangle and a vertex of the other (sides of planes) and those of two edges (how the line of an edge
/// passes the edges of the other triangle, as in Pluecker coordinates; see e.g. Devillers and Guigue, "Faster
/// Triangle-Triangle Intersection Tests", 2002).
Verdict decideBySigns(const Triangle& p, const Triangle& q)
{
  const auto size = [](const Vector3d& v) { return v.lpNorm<Eigen::Infinity>(); };
  Triangle edge_p;
  Triangle edge_q;
  std::array<double, 3> edge_p_size;
  std::array<double, 3> edge_q_size;
  for (int i = 0; i < 3; ++i)
  {
    edge_p[i] = p[(i + 1) % 3] - p[i];
    edge_q[i] = q[(i + 1) % 3] - q[i];
    edge_p_size[i] = size(edge_p[i]);
    edge_q_size[i] = size(edge_q[i]);
  }

  // On which side of the plane of `triangle` the vertices of `other` are; returns whether they are all on one, clearly
  // apart.
  const auto find_sides = [&size](const Triangle& triangle, const Triangle& edge,
                                  const std::array<double, 3>& edge_size, const Triangle& other,
                                  std::array<int, 3>& sides)
  {
    const Vector3d normal = edge[0].cross(edge[1]);
    const double tolerance = 2.0 * kContactTolerance * normal.norm();
    int apart = 0;
    for (int i = 0; i < 3; ++i)
    {
      const Vector3d between = other[i] - triangle[1];
      const double volume = normal.dot(between);
      const double error = volumeError(edge_size[0], edge_size[1], size(between));
      sides[i] = clearSign(volume, error);
      apart += clearSign(volume, error + tolerance);
    }
    return std::abs(apart) == 3;
  };
  std::array<int, 3> side_of_p;  // of the vertices of q
  std::array<int, 3> side_of_q;  // of the vertices of p
  if (find_sides(p, edge_p, edge_p_size, q, side_of_p) || find_sides(q, edge_q, edge_q_size, p, side_of_q))
  {
    return Verdict::Apart;
  }

  std::array<std::array<int, 3>, 3> turn;  // [i][j]: how edge i of p passes edge j of q
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      const Vector3d axis = edge_p[i].cross(edge_q[j]);
      const Vector3d between = q[j] - p[i];
      const double error = volumeError(edge_p_size[i], edge_q_size[j], size(between));
      turn[i][j] = clearSign(axis.dot(between), error);
      if (turn[i][j] != 0 && separates(axis, p, q))
      {
        return Verdict::Apart;
      }
    }
  }
  for (int i = 0; i < 3; ++i)
  {
    if (side_of_q[i] * side_of_q[(i + 1) % 3] < 0 && turn[i][0] != 0 && turn[i][0] == turn[i][1] &&
        turn[i][0] == turn[i][2])
    {
      return Verdict::Hit;
    }
    if (side_of_p[i] * side_of_p[(i + 1) % 3] < 0 && turn[0][i] != 0 && turn[0][i] == turn[1][i] &&
        turn[0][i] == turn[2][i])
    {
      return Verdict::Hit;
    }
  }
  return Verdict::Undecided;
}
}  // namespace

Vector3d nearestPoint(const Triangle& triangle, const Vector3d& point)
{
  const Vector3d& a = triangle[0];
  Vector3d best = a;
  double best_distance = (a - point).squaredNorm();
  const auto offer = [&](const Vector3d& candidate)
  {
    const double distance = (candidate - point).squaredNorm();
    if (distance < best_distance)
    {
      best_distance = distance;
      best = candidate;
    }
  };
  const Vector3d ab = triangle[1] - a;
  const Vector3d ac = triangle[2] - a;
  const Vector3d n = ab.cross(ac);
  const double nn = n.squaredNorm();
  if (nn > 0.0)
  {
    const Vector3d ap = point - a;
    const double v = ap.cross(ac).dot(n);
    const double w = ab.cross(ap).dot(n);
    if (v >= 0.0 && w >= 0.0 && v + w <= nn)
    {
      offer(a + (v / nn) * ab + (w / nn) * ac);
    }
  }
  // Also where the foot of the perpendicular seems to be inside: of a sliver's plane only rounding may be left.
  for (int i = 0; i < 3; ++i)
  {
    const Vector3d edge = triangle[(i + 1) % 3] - triangle[i];
    const double length = edge.squaredNorm();
    const double t = length > 0.0 ? std::clamp((point - triangle[i]).dot(edge) / length, 0.0, 1.0) : 0.0;
    offer(triangle[i] + t * edge);
  }
  return best;
}

bool trianglesMeet(const Triangle& a, const Triangle& b)
{
  const Verdict verdict = decideBySigns(a, b);
  if (verdict != Verdict::Undecided)
  {
    return verdict == Verdict::Hit;
  }
  return squaredDistanceOfOutlines(a, b) <= kContactTolerance * kContactTolerance;
}

bool trianglesWithin(const Triangle& a, const Triangle& b, double margin)
{
  return trianglesMeet(a, b) || squaredDistanceOfOutlines(a, b) <= margin * margin;
}
}  // namespace gpu_planning_scene
