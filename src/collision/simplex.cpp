#include "collision/simplex.h"

namespace gpu_planning_scene
{
using Eigen::Vector3d;

void Simplex::offer(Face& best, std::array<int, 4> points, int count, const Vector3d& nearest) const
{
  const double squared_distance = nearest.squaredNorm();
  if (best.count == 0 || squared_distance < best.squared_distance)
  {
    best = {count, points, nearest, squared_distance};
  }
}

void Simplex::offerSegment(Face& best, int a, int b) const
{
  const Vector3d step = points_[b] - points_[a];
  const double length = step.squaredNorm();
  const double share = -points_[a].dot(step);
  if (share <= 0.0)
  {
    offer(best, {a}, 1, points_[a]);
  }
  else if (share >= length)
  {
    offer(best, {b}, 1, points_[b]);
  }
  else
  {
    offer(best, {a, b}, 2, points_[a] + (share / length) * step);
  }
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

/// Of four points.
bool Simplex::holdsOrigin() const
{
  const Vector3d ab = points_[1] - points_[0];
  const Vector3d ac = points_[2] - points_[0];
  const Vector3d ad = points_[3] - points_[0];
  const double volume = ab.dot(ac.cross(ad));
  const double sign = volume > 0.0 ? 1.0 : -1.0;
  const double share_b = -sign * points_[0].dot(ac.cross(ad));
  const double share_c = -sign * points_[0].dot(ad.cross(ab));
  const double share_d = -sign * points_[0].dot(ab.cross(ac));
  return volume != 0.0 && share_b > 0.0 && share_c > 0.0 && share_d > 0.0 &&
         share_b + share_c + share_d < sign * volume;
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
  {
    points_[i] = all[best.points[i]];
  }
  count_ = best.count;
  nearest_ = best.nearest;
}
}  // namespace gpu_planning_scene
