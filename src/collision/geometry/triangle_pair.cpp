#include "collision/geometry/triangle_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math_constants.h"
#include "collision/geometry/exact_orientation.h"
#include "collision/geometry/precise_distance.h"

// Three stages, each slower and more certain than the one before: separating axes and the signs of volumes in double
// (Devillers and Guigue 2002); nearest points in double; exact signs and distances in quadruple precision.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

// A smaller squared length may lose digits to underflow, so it proves nothing.
constexpr double kUnderflow = 1e-280;

double sizeOf(const Vector3d& v)
{
  return v.lpNorm<Eigen::Infinity>();
}

/// An upper bound of the rounding error of the volume u x v . w. The three vectors are differences of coordinates; the
/// arguments are their largest components. The volume has six products of three factors, each with less than eight
/// roundings.
double volumeError(double u_size, double v_size, double w_size)
{
  return 6.0 * 8.0 * kEpsilon * u_size * v_size * w_size + std::numeric_limits<double>::min();
}

/// The sign of `value`, or 0 if the rounding error may have changed the sign.
int clearSign(double value, double error)
{
  return value > error ? 1 : value < -error ? -1 : 0;
}

enum class TriangleVerdict
{
  Hit,
  Apart,
  Undecided
};

/// Projects the vertices of two triangles, relative to a vertex of the second, with an upper bound of the rounding
/// error.
class PairProjections
{
 public:
  PairProjections(const Triangle& p, const Triangle& q)
    : vertices_{p[0] - q[0], p[1] - q[0], p[2] - q[0], q[1] - q[0], q[2] - q[0]}
  {
    double size = 0.0;
    for (const Vector3d& vertex : vertices_)
      size = std::max(size, sizeOf(vertex));
    // A projection rounds in its coordinate differences, its three products and its two sums. Each rounds by epsilon /
    // 2 of at most sqrt(3) size times the length of the axis.
    error_ = 8.0 * kEpsilon * size;
  }

  double size() const { return error_ / (8.0 * kEpsilon); }

  /// Whether the projections of the triangles on an axis are certainly farther apart than `distance`. If so, the
  /// triangles are too. The axis may have any length; rounding errors of its direction do not matter.
  bool apartAlong(const Vector3d& axis, double distance) const
  {
    const double p0 = axis.dot(vertices_[0]);
    const double p1 = axis.dot(vertices_[1]);
    const double p2 = axis.dot(vertices_[2]);
    const double q1 = axis.dot(vertices_[3]);
    const double q2 = axis.dot(vertices_[4]);
    const double gap =
        std::max(std::min({p0, p1, p2}) - std::max({0.0, q1, q2}), std::min({0.0, q1, q2}) - std::max({p0, p1, p2}));
    const double squared = axis.squaredNorm();
    return squared > kUnderflow && gap > (distance + error_) * std::sqrt(squared);
  }

  /// Moves a point of each triangle towards the other triangle. Hit: the points are within `distance`. Apart: see
  /// apartAlong, with the axis through the points. Each step adds the vertices that are nearest to each other along the
  /// axis (Gilbert, "An Iterative Procedure for Computing the Minimum of a Quadratic Form on a Convex Set", 1966).
  TriangleVerdict approach(double distance) const
  {
    constexpr int kSteps = 4;
    Vector3d axis = (vertices_[0] + vertices_[1] + vertices_[2] - vertices_[3] - vertices_[4]) / 3.0;
    for (int step = 0; step < kSteps; ++step)
    {
      if (axis.norm() + error_ <= distance)
        return TriangleVerdict::Hit;
      if (apartAlong(axis, distance))
        return TriangleVerdict::Apart;
      const Vector3d next = axis - (leastOfFirst(axis) - largestOfSecond(axis));
      const double length = next.squaredNorm();
      if (!(length > kUnderflow))
        break;
      axis -= std::clamp(axis.dot(next) / length, 0.0, 1.0) * next;
    }
    return TriangleVerdict::Undecided;
  }

 private:
  /// The vertex of the first triangle with the least projection.
  const Vector3d& leastOfFirst(const Vector3d& axis) const
  {
    return *std::min_element(
        vertices_.begin(), vertices_.begin() + 3,
        [&](const Vector3d& a, const Vector3d& b) { return axis.dot(a) < axis.dot(b); });
  }
  /// The vertex of the second triangle with the largest projection.
  Vector3d largestOfSecond(const Vector3d& axis) const
  {
    const double a = axis.dot(vertices_[3]);
    const double b = axis.dot(vertices_[4]);
    if (std::max(a, b) <= 0.0)
      return Vector3d::Zero();
    return a > b ? vertices_[3] : vertices_[4];
  }

  std::array<Vector3d, 5> vertices_;
  double error_;
};

/// Decides the pairs that double arithmetic can prove. Apart: an axis separates the triangles by more than `distance`.
/// Hit: the signs of volumes show that an edge of one triangle passes through the other. One kind of volume is spanned
/// by a triangle and a vertex of the other; it tells the side of the plane. The other kind is spanned by an edge of
/// each; as in Pluecker coordinates, it tells on which side the line of an edge passes the edges of the other triangle
/// (e.g. Devillers and Guigue, "Faster Triangle-Triangle Intersection Tests", 2002).
TriangleVerdict decideBySigns(const Triangle& p, const Triangle& q, const PairProjections& projections, double distance)
{
  Triangle edge_p;
  Triangle edge_q;
  std::array<double, 3> edge_p_size;
  std::array<double, 3> edge_q_size;
  for (int i = 0; i < 3; ++i)
  {
    edge_p[i] = p[(i + 1) % 3] - p[i];
    edge_q[i] = q[(i + 1) % 3] - q[i];
    edge_p_size[i] = sizeOf(edge_p[i]);
    edge_q_size[i] = sizeOf(edge_q[i]);
  }

  // Finds the side of the plane of `triangle` for each vertex of `other`. Returns whether all vertices are certainly on
  // one side and farther than `distance` from the plane.
  const auto find_sides = [distance](const Triangle& triangle, const Triangle& edge,
                                     const std::array<double, 3>& edge_size, const Triangle& other,
                                     std::array<int, 3>& sides)
  {
    const Vector3d normal = edge[0].cross(edge[1]);
    // The second term bounds the error of the normal, which may be mostly rounding error for a sliver.
    const double squared = normal.squaredNorm();
    const double tolerance = squared > kUnderflow
                                 ? distance * (std::sqrt(squared) + 16.0 * kEpsilon * edge_size[0] * edge_size[1])
                                 : std::numeric_limits<double>::infinity();
    int apart = 0;
    for (int i = 0; i < 3; ++i)
    {
      const Vector3d between = other[i] - triangle[1];
      const double volume = normal.dot(between);
      const double error = volumeError(edge_size[0], edge_size[1], sizeOf(between));
      sides[i] = clearSign(volume, error);
      apart += clearSign(volume, error + tolerance);
    }
    return std::abs(apart) == 3;
  };
  std::array<int, 3> side_of_p;  // sides of the plane of p, for the vertices of q
  std::array<int, 3> side_of_q;  // sides of the plane of q, for the vertices of p
  if (find_sides(p, edge_p, edge_p_size, q, side_of_p) || find_sides(q, edge_q, edge_q_size, p, side_of_q))
    return TriangleVerdict::Apart;

  std::array<std::array<int, 3>, 3> turn;  // [i][j]: the side on which edge i of p passes edge j of q
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      const Vector3d axis = edge_p[i].cross(edge_q[j]);
      const Vector3d between = q[j] - p[i];
      const double error = volumeError(edge_p_size[i], edge_q_size[j], sizeOf(between));
      turn[i][j] = clearSign(axis.dot(between), error);
      if (turn[i][j] != 0 && projections.apartAlong(axis, distance))
        return TriangleVerdict::Apart;
    }
  }
  for (int i = 0; i < 3; ++i)
  {
    if (side_of_q[i] * side_of_q[(i + 1) % 3] < 0 && turn[i][0] != 0 && turn[i][0] == turn[i][1] &&
        turn[i][0] == turn[i][2])
      return TriangleVerdict::Hit;
    if (side_of_p[i] * side_of_p[(i + 1) % 3] < 0 && turn[0][i] != 0 && turn[0][i] == turn[1][i] &&
        turn[0][i] == turn[2][i])
      return TriangleVerdict::Hit;
  }
  return TriangleVerdict::Undecided;
}

/// The shortest vector offered so far between a point of one shape and a point of the other.
struct Nearest
{
  double squared_distance = std::numeric_limits<double>::infinity();
  Vector3d between = Vector3d::Zero();

  void offer(const Vector3d& candidate)
  {
    const double squared = candidate.squaredNorm();
    if (squared < squared_distance)
    {
      squared_distance = squared;
      between = candidate;
    }
  }
};

/// Offers the nearest points of the two lines if they are inside both segments.
void offerNearestOfSegments(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0, const Vector3d& q1,
                            Nearest& nearest)
{
  const Vector3d u = p1 - p0;
  const Vector3d v = q1 - q0;
  const Vector3d w = p0 - q0;
  const Vector3d n = u.cross(v);
  const double nn = n.squaredNorm();
  const double s = v.cross(w).dot(n);
  const double t = u.cross(w).dot(n);
  if (nn > 0.0 && s >= 0.0 && s <= nn && t >= 0.0 && t <= nn)
    nearest.offer(w + (s / nn) * u - (t / nn) * v);
}

/// The nearest points of two triangles, if no edge of one passes through the inside of the other. Rounding may choose
/// other points, but they are always points of the triangles. So the distance is an upper bound in any case.
Nearest nearestOfOutlines(const Triangle& a, const Triangle& b)
{
  Nearest nearest;
  for (int i = 0; i < 3; ++i)
  {
    nearest.offer(nearestPoint(a, b[i]) - b[i]);
    nearest.offer(a[i] - nearestPoint(b, a[i]));
    for (int j = 0; j < 3; ++j)
      offerNearestOfSegments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3], nearest);
  }
  return nearest;
}

/// Whether the segment passes through the inside of the triangle from one side to the other, decided by exact signs.
bool segmentPierces(const Vector3d& start, const Vector3d& end, const Triangle& triangle)
{
  if (exactOrientation(triangle[0], triangle[1], triangle[2], start) *
          exactOrientation(triangle[0], triangle[1], triangle[2], end) >=
      0)
    return false;
  const int turn = exactOrientation(start, end, triangle[0], triangle[1]);
  return turn != 0 && turn == exactOrientation(start, end, triangle[1], triangle[2]) &&
         turn == exactOrientation(start, end, triangle[2], triangle[0]);
}

bool edgePierces(const Triangle& a, const Triangle& b)
{
  for (int i = 0; i < 3; ++i)
    if (segmentPierces(a[i], a[(i + 1) % 3], b) || segmentPierces(b[i], b[(i + 1) % 3], a))
      return true;
  return false;
}

double largestCoordinate(const Triangle& a, const Triangle& b)
{
  double size = 0.0;
  for (int i = 0; i < 3; ++i)
    size = std::max({size, sizeOf(a[i]), sizeOf(b[i])});
  return size;
}

bool lexicographicallyLess(const Vector3d& a, const Vector3d& b)
{
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
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
      offer(a + (v / nn) * ab + (w / nn) * ac);
  }
  // The edges are tried even if the foot of the perpendicular seems to be inside: the normal of a sliver may be mostly
  // rounding error.
  for (int i = 0; i < 3; ++i)
  {
    const Vector3d edge = triangle[(i + 1) % 3] - triangle[i];
    const double length = edge.squaredNorm();
    const double t = length > 0.0 ? std::clamp((point - triangle[i]).dot(edge) / length, 0.0, 1.0) : 0.0;
    offer(triangle[i] + t * edge);
  }
  return best;
}

Triangle sortedTriangle(const Triangle& triangle)
{
  Triangle sorted = triangle;
  std::sort(sorted.begin(), sorted.end(), lexicographicallyLess);
  return sorted;
}

bool precedes(const Triangle& a, const Triangle& b)
{
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lexicographicallyLess);
}

double outlineDistance(const Triangle& a, const Triangle& b)
{
  return std::sqrt(nearestOfOutlines(a, b).squared_distance);
}

bool trianglesWithin(const Triangle& a, const Triangle& b, double required)
{
  // All decisions before the last line are proven, so they cannot depend on the order of the vertices and of the
  // triangles.
  const double threshold = required + kSlack;
  const PairProjections projections(a, b);
  if (required > 0.0)
  {
    const TriangleVerdict verdict = projections.approach(threshold);
    if (verdict != TriangleVerdict::Undecided)
      return verdict == TriangleVerdict::Hit;
  }
  const TriangleVerdict verdict = decideBySigns(a, b, projections, threshold);
  if (verdict != TriangleVerdict::Undecided)
    return verdict == TriangleVerdict::Hit;
  const Nearest nearest = nearestOfOutlines(a, b);
  const double distance = std::sqrt(nearest.squared_distance);
  if (distance + 16.0 * kEpsilon * (largestCoordinate(a, b) + projections.size()) <= threshold)
    return true;
  if (projections.apartAlong(nearest.between, threshold))
    return false;
  return edgePierces(a, b) || preciseDistance(a, b) <= threshold;
}
}  // namespace gpu_planning_scene::core
