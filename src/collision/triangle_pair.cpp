#include "triangle_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gpu_planning_scene
{
namespace
{
using Eigen::Vector3d;

/// The sign of the volume u x v . w: -1, 0 or 1; 0 where rounding may have changed it. The vectors are differences of
/// coordinates, each of its largest absolute component `..._size`.
int signOfVolume(const Vector3d& u, const Vector3d& v, const Vector3d& w, double u_size, double v_size, double w_size)
{
  // Six products of three factors with relative errors of less than eight roundings in all.
  const double error = 6.0 * 8.0 * std::numeric_limits<double>::epsilon() * u_size * v_size * w_size;
  const double volume = u.cross(v).dot(w);
  return volume > error ? 1 : volume < -error ? -1 : 0;
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

/// Decides by the signs of volumes: those of one triangle and a vertex of the other (sides of planes) and those of two
/// edges (how the line of an edge passes the edges of the other triangle, as in Pluecker coordinates; see e.g.
/// Devillers and Guigue, "Faster Triangle-Triangle Intersection Tests", 2002).
Verdict decideBySigns(const Triangle& p, const Triangle& q)
{
  const auto size = [](const Vector3d& v) { return v.lpNorm<Eigen::Infinity>(); };
  Triangle edge_p;
  Triangle edge_q;
  std::array<Triangle, 3> between;  // [i][j]: from vertex i of p to vertex j of q
  std::array<double, 3> edge_p_size;
  std::array<double, 3> edge_q_size;
  std::array<std::array<double, 3>, 3> between_size;
  for (int i = 0; i < 3; ++i)
  {
    edge_p[i] = p[(i + 1) % 3] - p[i];
    edge_q[i] = q[(i + 1) % 3] - q[i];
    edge_p_size[i] = size(edge_p[i]);
    edge_q_size[i] = size(edge_q[i]);
    for (int j = 0; j < 3; ++j)
    {
      between[i][j] = q[j] - p[i];
      between_size[i][j] = size(between[i][j]);
    }
  }

  std::array<int, 3> side_of_p;  // of the vertices of q
  std::array<int, 3> side_of_q;  // of the vertices of p
  for (int i = 0; i < 3; ++i)
  {
    side_of_p[i] =
        signOfVolume(edge_p[0], edge_p[1], between[1][i], edge_p_size[0], edge_p_size[1], between_size[1][i]);
  }
  if (side_of_p[0] != 0 && side_of_p[0] == side_of_p[1] && side_of_p[0] == side_of_p[2])
  {
    return Verdict::Apart;
  }
  for (int i = 0; i < 3; ++i)
  {
    side_of_q[i] =
        signOfVolume(edge_q[0], edge_q[1], between[i][1], edge_q_size[0], edge_q_size[1], between_size[i][1]);
  }
  if (side_of_q[0] != 0 && side_of_q[0] == side_of_q[1] && side_of_q[0] == side_of_q[2])
  {
    return Verdict::Apart;
  }

  std::array<std::array<int, 3>, 3> turn;  // [i][j]: how edge i of p passes edge j of q
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      turn[i][j] =
          signOfVolume(edge_p[i], edge_q[j], between[i][j], edge_p_size[i], edge_q_size[j], between_size[i][j]);
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
  // No edge clearly pierces. They are apart if each edge clearly misses: it stays on one side of the other's plane, or
  // passes two of the other's edges on different sides.
  const auto misses = [](int side_1, int side_2, int turn_1, int turn_2, int turn_3)
  {
    const bool one_side = side_1 != 0 && side_1 == side_2;
    const bool outside = std::min({turn_1, turn_2, turn_3}) < 0 && std::max({turn_1, turn_2, turn_3}) > 0;
    return one_side || outside;
  };
  for (int i = 0; i < 3; ++i)
  {
    if (!misses(side_of_q[i], side_of_q[(i + 1) % 3], turn[i][0], turn[i][1], turn[i][2]) ||
        !misses(side_of_p[i], side_of_p[(i + 1) % 3], turn[0][i], turn[1][i], turn[2][i]))
    {
      return Verdict::Undecided;
    }
  }
  return Verdict::Apart;
}
}  // namespace

Vector3d nearestPoint(const Triangle& triangle, const Vector3d& point)
{
  const Vector3d& a = triangle[0];
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
      return a + (v / nn) * ab + (w / nn) * ac;
    }
  }
  Vector3d best = a;
  double best_distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
  {
    const Vector3d edge = triangle[(i + 1) % 3] - triangle[i];
    const double length = edge.squaredNorm();
    const double t = length > 0.0 ? std::clamp((point - triangle[i]).dot(edge) / length, 0.0, 1.0) : 0.0;
    const Vector3d candidate = triangle[i] + t * edge;
    const double distance = (candidate - point).squaredNorm();
    if (distance < best_distance)
    {
      best_distance = distance;
      best = candidate;
    }
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
