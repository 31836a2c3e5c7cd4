#include "collision/geometry/convex_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math_constants.h"
#include "collision/geometry/simplex.h"

// Two methods. The algorithm of Gilbert, Johnson and Keerthi (1988), in double, proves the answer for nearly all pairs.
// If the distance is within rounding of the required distance, the direction between the nearest points is mostly
// rounding error. A search for a separating direction, which always ends, then decides. The search takes a hundred
// times longer, so the direction that separated the pair before is tried first.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr int kMaxIterations = 48;
/// Accuracy of the greatest gap that the search finds.
constexpr double kGapAccuracy = 1e-13;  // metres

/// The Minkowski difference a - b. Its distance from the origin is the distance between a and b.
class MinkowskiDifference
{
 public:
  MinkowskiDifference(const Convex& a, const Convex& b)
    : a_(a), b_(b), center_(a.center() - b.center()), radius_(a.radius() + b.radius())
  {
    size_ = radius_ + a.center().norm() + b.center().norm();
  }

  Vector3d nearestAlong(const Vector3d& direction) const { return a_.farthest(-direction) - b_.farthest(direction); }

  const Vector3d& center() const { return center_; }
  double radius() const { return radius_; }

  /// An upper bound of the rounding error of a point of the difference, and of the projection of this point on a unit
  /// vector.
  double rounding() const { return 32.0 * kEpsilon * size_; }

  /// Whether a plane across the direction certainly separates the difference from the origin, at a larger distance than
  /// `distance`. False for the direction 0.
  bool isApartAlong(const Vector3d& direction, double distance) const
  {
    return direction.dot(nearestAlong(direction)) > (distance + rounding()) * direction.norm();
  }

 private:
  const Convex& a_;
  const Convex& b_;
  Vector3d center_;
  double radius_;
  double size_;
};

enum class ConvexVerdict
{
  Within,
  Apart,
  Undecided
};

/// Sets `nearest` to the nearest point of the difference that was found. The verdicts are proven. Within: a point of
/// the difference is within `distance` of the origin. Apart: a plane at a larger distance separates the difference from
/// the origin, and `nearest` is its normal.
ConvexVerdict decideByDescent(const MinkowskiDifference& difference, double distance, const Vector3d& guess,
                              Vector3d& nearest)
{
  const double rounding = difference.rounding();
  const Vector3d first = difference.nearestAlong(guess);
  nearest = guess;
  if (guess.dot(first) > (distance + rounding) * guess.norm())
    return ConvexVerdict::Apart;
  Simplex simplex(first);
  for (int i = 0; i < kMaxIterations; ++i)
  {
    nearest = simplex.nearest();
    const double length = nearest.norm();
    if (length + rounding <= distance)
      return ConvexVerdict::Within;
    const Vector3d point = difference.nearestAlong(nearest);
    const double gap = nearest.dot(point);
    if (gap > (distance + rounding) * length)
      return ConvexVerdict::Apart;
    if (simplex.full() || length * length - gap <= rounding * length)
      break;
    simplex.add(point);
  }
  return ConvexVerdict::Undecided;
}

/// Searches the directions n = m + alpha u + beta v, with alpha and beta in [-reach, reach], for one along which the
/// difference is farther than `distance` from the origin. The function F(n) = min n . x - distance |n|, over the points
/// x of the difference, is concave, so nested golden-section searches (Kiefer 1953) find its maximum.
class DirectionSearch
{
 public:
  DirectionSearch(const MinkowskiDifference& difference, double distance) : difference_(difference), distance_(distance)
  {
  }

  bool separates(const Vector3d& m, const Vector3d& u, const Vector3d& v, double reach)
  {
    // For each unit of alpha or beta, F changes by at most the sum of these sizes.
    const double step = std::max(kGapAccuracy / (difference_.radius() + difference_.center().norm() + distance_),
                                 16.0 * kEpsilon * reach);
    const auto along_v = [&](double alpha)
    { return maximum([&](double beta) { return excess(m + alpha * u + beta * v); }, reach, step); };
    return maximum(along_v, reach, step) > 0.0;
  }

  /// The direction with the largest value so far.
  const Vector3d& best() const { return best_; }

 private:
  double excess(const Vector3d& n)
  {
    const double value = n.dot(difference_.nearestAlong(n)) - distance_ * n.norm();
    if (value > most_)
    {
      most_ = value;
      best_ = n;
    }
    return value;
  }

  /// The maximum of a concave function on [-reach, reach]. Stops early at a value that is certainly above 0.
  template <class Function>
  double maximum(const Function& function, double reach, double step) const
  {
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    double low = -reach;
    double high = reach;
    double left = high - golden * (high - low);
    double right = low + golden * (high - low);
    double at_left = function(left);
    double at_right = function(right);
    const double enough = 2.0 * difference_.rounding();
    while (high - low > step && at_left <= enough && at_right <= enough)
    {
      if (at_left >= at_right)
      {
        high = right;
        right = left;
        at_right = at_left;
        left = high - golden * (high - low);
        at_left = function(left);
      }
      else
      {
        low = left;
        left = right;
        at_left = at_right;
        right = low + golden * (high - low);
        at_right = function(right);
      }
    }
    return std::max(at_left, at_right);
  }

  const MinkowskiDifference& difference_;
  double distance_;
  double most_ = -std::numeric_limits<double>::infinity();
  Vector3d best_ = Vector3d::Zero();
};

/// `near` is a point of the difference; its distance from the origin is more than `distance`, up to rounding. Each
/// separating direction n fulfils n . near > distance |n|.
bool isSeparable(const MinkowskiDifference& difference, double distance, const Vector3d& near, DirectionSearch& search)
{
  const double length = near.norm();
  const Vector3d m = near / length;
  const Vector3d u = m.unitOrthogonal();
  const Vector3d v = m.cross(u);
  // Because n . near = length, a separating direction n has |n| < length / distance. Some room is added for the
  // rounding of `near`.
  const double ratio = (length + difference.rounding()) / distance;
  const double all = 1.01 * std::sqrt(std::max(0.0, ratio * ratio - 1.0)) + 4.0 * difference.rounding() / length;
  constexpr double kWide = 8.0;
  constexpr double kNarrow = 0.01;
  if (all <= kWide)
    return search.separates(m, u, v, all);
  // The direction of `near` is most likely a separating one, so a small search around it comes first. If it fails, the
  // directions n to the six faces of a cube are searched. A face is left out if n . centre is at most 0 for all of its
  // directions.
  if (search.separates(m, u, v, kNarrow))
    return true;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double sign : {-1.0, 1.0})
    {
      const double most = difference.center().lpNorm<1>() -
                          (sign * difference.center()[axis] < 0.0 ? 2.0 * std::abs(difference.center()[axis]) : 0.0);
      if (most > 0.0 && search.separates(sign * Vector3d::Unit(axis), Vector3d::Unit((axis + 1) % 3),
                                         Vector3d::Unit((axis + 2) % 3), 1.0))
        return true;
    }
  }
  return false;
}
}  // namespace

double convexDistance(const Convex& a, const Convex& b, const Vector3d& from_b)
{
  constexpr double kAccuracy = 1e-7;  // metres
  const MinkowskiDifference difference(a, b);
  Simplex simplex(difference.nearestAlong(from_b));
  double length = 0.0;
  for (int i = 0; i < kMaxIterations; ++i)
  {
    const Vector3d nearest = simplex.nearest();
    length = nearest.norm();
    if (simplex.full() || length <= difference.rounding())
      return 0.0;
    const Vector3d point = difference.nearestAlong(nearest);
    if (length * length - nearest.dot(point) <= kAccuracy * length)
      break;
    simplex.add(point);
  }
  return length;
}

bool convexWithin(const Convex& a, const Convex& b, double distance, const Vector3d& from_b, SeparatingAxis* axis)
{
  const MinkowskiDifference difference(a, b);
  if (difference.center().norm() > difference.radius() + distance + difference.rounding())
    return false;
  if (axis && difference.isApartAlong(axis->direction, distance))
    return false;
  Vector3d nearest;
  const ConvexVerdict verdict = decideByDescent(difference, distance, from_b, nearest);
  if (verdict == ConvexVerdict::Within)
    return true;
  Vector3d normal = nearest;
  if (verdict == ConvexVerdict::Undecided)
  {
    DirectionSearch search(difference, distance);
    if (axis)
      ++axis->searches;
    if (!isSeparable(difference, distance, nearest, search))
      return true;
    normal = search.best();
  }
  if (axis)
    axis->direction = normal;
  return false;
}
}  // namespace gpu_planning_scene::core
