#include "collision/geometry/convex_separation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "collision/geometry/simplex.h"

// The Minkowski difference a - b contains the origin if the sets overlap. If they do not, the algorithm of Gilbert,
// Johnson and Keerthi (1988) finds its point that is nearest to the origin. If they do, the expanding polytope
// algorithm (van den Bergen, "Proximity Queries and Penetration Depth Computation on 3D Game Objects", 2001) finds the
// face that is nearest to the origin. Both only propose directions: the support functions give the depth of a
// direction.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr int kMaxDescents = 64;
constexpr int kMaxExpansions = 160;
/// Relative to the sizes of the sets.
constexpr double kRelativeAccuracy = 1e-9;
/// A nearer point gives no direction that can be relied on, relative to the sizes of the sets.
constexpr double kNearOrigin = 1e-7;
constexpr double kFlat = 1e-11;

/// A point of the Minkowski difference, with the points of a and b.
struct Corner
{
  Vector3d on_a = Vector3d::Zero();
  Vector3d on_b = Vector3d::Zero();
  Vector3d difference = Vector3d::Zero();
};

/// The shares of four points in the origin, which is in their hull.
std::array<double, 4> sharesInOrigin(const std::array<Vector3d, 4>& points)
{
  const Vector3d u = points[1] - points[0];
  const Vector3d v = points[2] - points[0];
  const Vector3d w = points[3] - points[0];
  const double volume = u.cross(v).dot(w);
  const double second = -v.cross(w).dot(points[0]) / volume;
  const double third = -w.cross(u).dot(points[0]) / volume;
  const double fourth = -u.cross(v).dot(points[0]) / volume;
  return {1.0 - second - third - fourth, second, third, fourth};
}

/// The shares of up to three points in a point of their hull, which is given up to rounding.
std::array<double, 3> sharesOf(const std::array<Vector3d, 3>& points, int count, const Vector3d& target)
{
  if (count == 1)
    return {1.0, 0.0, 0.0};
  const Vector3d u = points[1] - points[0];
  const Vector3d p = target - points[0];
  if (count == 2)
  {
    const double share = std::clamp(u.dot(p) / u.squaredNorm(), 0.0, 1.0);
    return {1.0 - share, share, 0.0};
  }
  const Vector3d v = points[2] - points[0];
  const Vector3d normal = u.cross(v);
  const double nn = normal.squaredNorm();
  if (!(nn > 0.0))
    return {1.0, 0.0, 0.0};
  std::array<double, 3> shares = {0.0, p.cross(v).dot(normal) / nn, u.cross(p).dot(normal) / nn};
  shares[0] = 1.0 - shares[1] - shares[2];
  double sum = 0.0;
  for (double& share : shares)
    sum += share = std::max(0.0, share);
  for (double& share : shares)
    share /= sum;
  return shares;
}

class Difference
{
 public:
  Difference(const Convex& a, const Convex& b) : a_(a), b_(b), size_(a.radius() + b.radius()) {}

  /// The corner that is farthest along a direction.
  Corner along(const Vector3d& direction) const
  {
    const Vector3d on_a = a_.farthest(direction);
    const Vector3d on_b = b_.farthest(-direction);
    return {on_a, on_b, on_a - on_b};
  }
  double size() const { return size_; }
  Vector3d fromAToB() const { return b_.center() - a_.center(); }

 private:
  const Convex& a_;
  const Convex& b_;
  double size_;
};

/// Keeps the best direction so far.
class BestDirection
{
 public:
  explicit BestDirection(const Difference& difference) : difference_(difference) {}

  /// Offers a direction of unit length. `corners`: of a face of the difference that contains depth * normal.
  Corner offer(const Vector3d& normal, const std::array<Corner, 3>& corners, int count)
  {
    Corner farthest = difference_.along(normal);
    const double depth = normal.dot(farthest.difference);
    if (found_ && depth >= found_->depth)
      return farthest;
    std::array<Vector3d, 3> points;
    for (int i = 0; i < count; ++i)
      points[i] = corners[i].difference;
    const std::array<double, 3> shares = sharesOf(points, count, depth * normal);
    found_ = ConvexSeparation{normal, depth, Vector3d::Zero(), Vector3d::Zero()};
    for (int i = 0; i < count; ++i)
    {
      found_->on_a += shares[i] * corners[i].on_a;
      found_->on_b += shares[i] * corners[i].on_b;
    }
    return farthest;
  }
  Corner offer(const Vector3d& normal) { return offer(normal, {difference_.along(normal)}, 1); }

  /// Tells that no direction has a depth below `depth`, up to rounding.
  void bound(double depth) { least_depth_ = std::max(least_depth_, depth - kFlat * difference_.size()); }

  const std::optional<ConvexSeparation>& found() const { return found_; }

  /// The result. Close to contact, the corners of a direction need not be those of the nearest points.
  ConvexSeparation result(const Convex& a, const Convex& b) const
  {
    ConvexSeparation result = *found_;
    result.least_depth = std::min(least_depth_, result.depth);
    const Vector3d between = result.depth * result.normal;
    if (result.depth < 0.0 && (result.on_a - result.on_b - between).norm() > kRelativeAccuracy * difference_.size())
    {
      const Vector3d middle = commonPoint(a, b);
      result.on_a = middle + 0.5 * between;
      result.on_b = middle - 0.5 * between;
    }
    return result;
  }

 private:
  const Difference& difference_;
  double least_depth_ = -std::numeric_limits<double>::infinity();
  std::optional<ConvexSeparation> found_;
};

/// Finds the direction for sets that are apart. Returns whether the sets are clearly apart, so that no other direction
/// can be better.
bool descend(const Difference& difference, BestDirection& best)
{
  std::vector<Corner> corners = {difference.along(difference.fromAToB())};
  Simplex simplex(corners.front().difference);
  for (int i = 0; i < kMaxDescents; ++i)
  {
    const Vector3d nearest = simplex.nearest();
    const double length = nearest.norm();
    if (simplex.full() || length <= kNearOrigin * difference.size())
      return false;
    const Corner corner = difference.along(-nearest);
    if (length * length - nearest.dot(corner.difference) <= 1e-14 * length * (difference.size() + length))
      break;
    corners.push_back(corner);
    simplex.add(corner.difference);
  }
  const Vector3d nearest = simplex.nearest();
  if (simplex.full() || nearest.norm() <= kNearOrigin * difference.size())
    return false;
  std::array<Corner, 3> face;
  for (int i = 0; i < simplex.count(); ++i)
    face[i] = *std::find_if(corners.begin(), corners.end(),
                            [&](const Corner& corner) { return corner.difference == simplex.point(i); });
  best.offer(-nearest.normalized(), face, simplex.count());
  best.bound(-nearest.norm());
  return nearest.norm() + best.found()->depth <= kRelativeAccuracy * difference.size();
}

/// A polytope inside the Minkowski difference.
class Polytope
{
 public:
  struct Face
  {
    std::array<int, 3> corners;  // counterclockwise, from outside
    Vector3d normal;             // of unit length; 0 if the face has no area
    double offset;
  };

  void start(const std::array<Corner, 4>& corners)
  {
    corners_.assign(corners.begin(), corners.end());
    const Vector3d& origin = corners_[0].difference;
    const double volume =
        (corners_[1].difference - origin).cross(corners_[2].difference - origin).dot(corners_[3].difference - origin);
    const int i = volume > 0.0 ? 1 : 0;
    const int j = 1 - i;
    addFace({i, j, 2});
    addFace({j, i, 3});
    addFace({2, j, 3});
    addFace({i, 2, 3});
  }

  const Face& nearestFace() const
  {
    return *std::min_element(
        faces_.begin(), faces_.end(), [](const Face& a, const Face& b) { return a.offset < b.offset; });
  }
  std::array<Corner, 3> cornersOf(const Face& face) const
  {
    return {corners_[face.corners[0]], corners_[face.corners[1]], corners_[face.corners[2]]};
  }

  /// Adds a corner. Replaces the faces that it sees by faces from it to their outline.
  void expand(const Corner& corner, double rounding)
  {
    edges_.clear();
    for (std::size_t i = 0; i < faces_.size();)
    {
      const Face& face = faces_[i];
      if (face.normal.dot(corner.difference) <= face.offset + rounding)
      {
        ++i;
        continue;
      }
      for (int k = 0; k < 3; ++k)
        edges_.push_back({face.corners[k], face.corners[(k + 1) % 3]});
      faces_[i] = faces_.back();
      faces_.pop_back();
    }
    const int added = static_cast<int>(corners_.size());
    corners_.push_back(corner);
    for (const auto& [from, to] : edges_)
      if (std::find(edges_.begin(), edges_.end(), std::array<int, 2>{to, from}) == edges_.end())
        addFace({from, to, added});
  }
  bool empty() const { return faces_.empty(); }

 private:
  void addFace(const std::array<int, 3>& corners)
  {
    const Vector3d& first = corners_[corners[0]].difference;
    const Vector3d normal = (corners_[corners[1]].difference - first).cross(corners_[corners[2]].difference - first);
    const double length = normal.norm();
    if (length > 0.0)
      faces_.push_back({corners, normal / length, normal.dot(first) / length});
    else
      faces_.push_back({corners, Vector3d::Zero(), std::numeric_limits<double>::infinity()});
  }

  std::vector<Corner> corners_;
  std::vector<Face> faces_;
  std::vector<std::array<int, 2>> edges_;
};

/// Four corners that span a volume. If the difference is flat, a segment or a point, the result is empty, and
/// directions in which it has no extent are offered instead.
std::optional<std::array<Corner, 4>> firstCorners(const Difference& difference, BestDirection& best)
{
  const double flat = kFlat * difference.size();
  Corner first;
  Corner second;
  double longest = -1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Corner high = difference.along(Vector3d::Unit(axis));
    const Corner low = difference.along(-Vector3d::Unit(axis));
    const double length = high.difference[axis] - low.difference[axis];
    if (length <= longest)
      continue;
    longest = length;
    first = high;
    second = low;
  }
  if (longest <= flat)
  {
    const Vector3d direction = difference.fromAToB();
    best.offer(direction.norm() > flat ? Vector3d(direction.normalized()) : Vector3d::UnitZ());
    return std::nullopt;
  }
  const Vector3d line = (second.difference - first.difference).normalized();
  const Vector3d across = line.unitOrthogonal();
  Corner third;
  double farthest = -1.0;
  for (const Vector3d& direction : {across, Vector3d(line.cross(across))})
    for (const double sign : {-1.0, 1.0})
    {
      const Corner corner = difference.along(sign * direction);
      const double distance = line.cross(corner.difference - first.difference).norm();
      if (distance <= farthest)
        continue;
      farthest = distance;
      third = corner;
    }
  if (farthest <= flat)
  {
    const Vector3d offset = first.difference - line.dot(first.difference) * line;
    const Vector3d normal = offset.norm() > flat ? Vector3d(offset.normalized()) : across;
    best.offer(normal);
    best.offer(-normal);
    return std::nullopt;
  }
  const Vector3d normal = line.cross(third.difference - first.difference).normalized();
  const Corner above = best.offer(normal);
  const Corner below = best.offer(-normal);
  const double height = normal.dot(above.difference - first.difference);
  const double depth = -normal.dot(below.difference - first.difference);
  if (std::max(height, depth) <= flat)
    return std::nullopt;
  return std::array<Corner, 4>{first, second, third, height >= depth ? above : below};
}

/// Finds the direction for sets that overlap or touch.
void expandPolytope(const Difference& difference, BestDirection& best)
{
  const auto corners = firstCorners(difference, best);
  if (!corners)
    return;
  const double accuracy = kRelativeAccuracy * difference.size();
  Polytope polytope;
  polytope.start(*corners);
  for (int i = 0; i < kMaxExpansions && !polytope.empty(); ++i)
  {
    const Polytope::Face face = polytope.nearestFace();
    if (!std::isfinite(face.offset))
      return;
    const Corner corner = best.offer(face.normal, polytope.cornersOf(face), 3);
    // The polytope lies inside the difference, so no direction is better than its nearest face.
    best.bound(face.offset);
    if (best.found()->depth - face.offset <= accuracy || face.normal.dot(corner.difference) - face.offset <= accuracy)
      return;
    polytope.expand(corner, kFlat * difference.size());
  }
}
}  // namespace

Vector3d commonPoint(const Convex& a, const Convex& b)
{
  const Difference difference(a, b);
  std::vector<Corner> corners = {difference.along(difference.fromAToB())};
  Simplex simplex(corners.front().difference);
  for (int i = 0; i < kMaxDescents; ++i)
  {
    const Vector3d nearest = simplex.nearest();
    const double length = nearest.norm();
    if (simplex.full() || length <= kFlat * difference.size())
      break;
    const Corner corner = difference.along(-nearest);
    if (length * length - nearest.dot(corner.difference) <= 1e-14 * length * (difference.size() + length))
      break;
    corners.push_back(corner);
    simplex.add(corner.difference);
  }
  std::array<Corner, 4> used;
  for (int i = 0; i < simplex.count(); ++i)
    used[i] = *std::find_if(corners.begin(), corners.end(),
                            [&](const Corner& corner) { return corner.difference == simplex.point(i); });
  std::array<double, 4> shares = {};
  if (simplex.full())
  {
    shares = sharesInOrigin({simplex.point(0), simplex.point(1), simplex.point(2), simplex.point(3)});
  }
  else
  {
    const std::array<Vector3d, 3> points = {used[0].difference, used[1].difference, used[2].difference};
    const std::array<double, 3> of_face = sharesOf(points, simplex.count(), simplex.nearest());
    std::copy(of_face.begin(), of_face.end(), shares.begin());
  }
  Vector3d point = Vector3d::Zero();
  for (int i = 0; i < simplex.count(); ++i)
    point += 0.5 * shares[i] * (used[i].on_a + used[i].on_b);
  return point;
}

ConvexSeparation separationOf(const Convex& a, const Convex& b)
{
  const Difference difference(a, b);
  BestDirection best(difference);
  if (!descend(difference, best))
    expandPolytope(difference, best);
  return best.result(a, b);
}
}  // namespace gpu_planning_scene::core
