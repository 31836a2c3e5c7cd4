#include "collision/geometry/simplex.h"

#include <cmath>
#include <limits>

// Finds the face of the hull that is nearest to the origin by trying its faces, edges and points (the distance
// subalgorithm of Gilbert, Johnson and Keerthi 1988, in a direct form for at most four points).
namespace gpu_planning_scene::core
{
using Eigen::Vector3d;

void Simplex::offer(Face& best, std::array<int, 4> points, int count, const Vector3d& nearest) const
{
  const double squared_distance = nearest.squaredNorm();
  if (best.count == 0 || squared_distance < best.squared_distance)
    best = {count, points, nearest, squared_distance};
}

void Simplex::offerSegment(Face& best, int a, int b) const
{
  const Vector3d step = points_[b] - points_[a];
  const double length = step.squaredNorm();
  const double share = -points_[a].dot(step);
  if (share <= 0.0)
    offer(best, {a}, 1, points_[a]);
  else if (share >= length)
    offer(best, {b}, 1, points_[b]);
  else
    offer(best, {a, b}, 2, points_[a] + (share / length) * step);
}

void Simplex::offerTriangle(Face& best, int a, int b, int c) const
{
  const Vector3d& corner = points_[a];
  const Vector3d ab = points_[b] - corner;
  const Vector3d ac = points_[c] - corner;
  const Vector3d normal = ab.cross(ac);
  const double nn = normal.squaredNorm();
  const double share_b = ac.cross(corner).dot(normal);
  const double share_c = corner.cross(ab).dot(normal);
  if (nn > 0.0 && share_b > 0.0 && share_c > 0.0 && share_b + share_c < nn)
  {
    offer(best, {a, b, c}, 3, corner + (share_b / nn) * ab + (share_c / nn) * ac);
    return;
  }
  offerSegment(best, a, b);
  offerSegment(best, b, c);
  offerSegment(best, c, a);
}

/// Whether the hull of the four points contains the origin for certain, in spite of rounding. False for nearly flat
/// hulls, where rounding decides.
bool Simplex::holdsOrigin() const
{
  const Vector3d ab = points_[1] - points_[0];
  const Vector3d ac = points_[2] - points_[0];
  const Vector3d ad = points_[3] - points_[0];
  const Vector3d& corner = points_[0];
  // The rounding error of a volume is below 48 epsilon times the product of its edges.
  const auto error = [](const Vector3d& u, const Vector3d& v, const Vector3d& w)
  { return 48.0 * std::numeric_limits<double>::epsilon() * std::sqrt(u.squaredNorm() * v.squaredNorm()) * w.norm(); };
  const double volume = ab.dot(ac.cross(ad));
  const double sign = volume > 0.0 ? 1.0 : -1.0;
  const double share_b = -sign * corner.dot(ac.cross(ad));
  const double share_c = -sign * corner.dot(ad.cross(ab));
  const double share_d = -sign * corner.dot(ab.cross(ac));
  const double error_b = error(corner, ac, ad);
  const double error_c = error(corner, ad, ab);
  const double error_d = error(corner, ab, ac);
  return share_b > error_b && share_c > error_c && share_d > error_d &&
         sign * volume - share_b - share_c - share_d > error(ab, ac, ad) + error_b + error_c + error_d;
}

void Simplex::add(const Vector3d& point)
{
  points_[count_++] = point;
  Face best;
  if (count_ == 2)
  {
    offerSegment(best, 0, 1);
  }
  else if (count_ == 3)
  {
    offerTriangle(best, 0, 1, 2);
  }
  else if (holdsOrigin())
  {
    nearest_.setZero();
    return;
  }
  else
  {
    offerTriangle(best, 0, 1, 2);
    offerTriangle(best, 3, 0, 1);
    offerTriangle(best, 3, 1, 2);
    offerTriangle(best, 3, 2, 0);
  }
  const std::array<Vector3d, 4> all = points_;
  for (int i = 0; i < best.count; ++i)
    points_[i] = all[best.points[i]];
  count_ = best.count;
  nearest_ = best.nearest;
}
}  // namespace gpu_planning_scene::core
