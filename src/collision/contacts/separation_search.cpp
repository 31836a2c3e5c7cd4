#include "collision/contacts/separation_search.h"

#include <algorithm>
#include <limits>

#include "collision/exact/pair_clearance.h"
#include "collision/geometry/triangle_pair.h"

// A plane that separates the convex hulls of two shapes also separates the shapes, so the hulls always give a
// translation. If a shape is not convex, a shorter translation may be enough. It is searched with the exact test of the
// whole bodies along a few directions. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Parts of a pair from which directions are taken.
constexpr std::size_t kMaxMeetingParts = 256;
constexpr std::size_t kMaxFaceNormals = 4;
/// Pairs of shapes from which directions are taken.
constexpr std::size_t kMaxPairs = 8;
/// A search along a direction begins at this depth.
constexpr double kFirstDepth = 1e-7;  // metres
constexpr double kDepthGrowth = 4.0;
/// The contract allows no collision at a larger distance than this beyond the required one.
constexpr double kLeastGap = 1e-9;  // metres
/// Exceeds the error of pairClearance.
constexpr double kDistanceAccuracy = 1.1e-6;  // metres
/// Directions that are not better by this share are not distinguished.
constexpr double kBetter = 1e-6;

class TranslationSearch
{
 public:
  TranslationSearch(const std::vector<ContactPair>& pairs, const CpuShapePair& exact, CpuShapePair::Scratch& scratch)
    : pairs_(pairs), exact_(exact), scratch_(scratch)
  {
    bounds_.reserve(pairs.size());
    for (const ContactPair& pair : pairs)
      bounds_.push_back({boundsOf(*pair.a.tree, pair.a.pose), boundsOf(*pair.b.tree, pair.b.pose)});
  }

  /// Offers a direction with a depth that separates the hulls of all pairs.
  void offerProven(const Vector3d& normal, double depth)
  {
    if (depth < best_.depth)
      best_ = {normal, depth};
  }

  /// Offers the axis along which the boxes of the bodies are separated by the shortest translation.
  void offerAxis()
  {
    AlignedBox3d a;
    AlignedBox3d b;
    double required = 0.0;
    for (std::size_t i = 0; i < pairs_.size(); ++i)
    {
      a.extend(bounds_[i].a);
      b.extend(bounds_[i].b);
      required = std::max(required, pairs_[i].required);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      offerProven(Vector3d::Unit(axis), a.max()[axis] - b.min()[axis] + required + kSeparationGap);
      offerProven(-Vector3d::Unit(axis), b.max()[axis] - a.min()[axis] + required + kSeparationGap);
    }
  }

  /// Searches the least depth along a direction, and keeps the direction if it is better than the best one so far. The
  /// depth grows until the bodies are apart, and is then bisected.
  void offer(const Vector3d& normal)
  {
    double low = 0.0;
    double high = kFirstDepth;
    const double most = (1.0 - kBetter) * best_.depth;
    while (high < most && !isApart(normal, high))
    {
      low = high;
      high *= kDepthGrowth;
    }
    if (high >= most)
    {
      high = most;
      if (low >= high || !isApart(normal, high))
        return;
    }
    const double resolution = std::max(1e-9, 1e-8 * high);
    while (high - low > resolution)
    {
      const double middle = 0.5 * (low + high);
      (isApart(normal, middle) ? high : low) = middle;
    }
    if (isApart(normal, high + kSeparationGap))
      high += kSeparationGap;
    best_ = {normal, high};
  }

  /// The best translation. It is tested; if it is too short, it grows until the bodies are kLeastGap apart. It is too
  /// short because of rounding, or because the last parts that meet leave each other in another direction.
  Separation best() const
  {
    Separation found = best_;
    for (double growth = kSeparationGap; !isApart(found.normal, found.depth, kLeastGap) && growth < 1.0; growth *= 2.0)
      found.depth += growth;
    return found;
  }

 private:
  /// Whether the translation brings all pairs farther apart than their required distance and `gap`.
  bool isApart(const Vector3d& normal, double depth, double gap = 0.0) const
  {
    const Vector3d translation = depth * normal;
    for (std::size_t i = 0; i < pairs_.size(); ++i)
    {
      const ContactPair& pair = pairs_[i];
      const AlignedBox3d& a = bounds_[i].a;
      const AlignedBox3d& b = bounds_[i].b;
      const double required = pair.required + gap;
      if ((b.min() + translation - a.max()).cwiseMax(a.min() - b.max() - translation).maxCoeff() > required)
        continue;
      Eigen::Isometry3d moved = pair.b.pose;
      moved.pretranslate(translation);
      if (exact_.collide(*pair.a.tree, pair.a.pose, *pair.b.tree, moved, required, scratch_))
        return false;
    }
    return true;
  }

  struct Bounds
  {
    AlignedBox3d a;
    AlignedBox3d b;
  };

  const std::vector<ContactPair>& pairs_;
  const CpuShapePair& exact_;
  CpuShapePair::Scratch& scratch_;
  std::vector<Bounds> bounds_;
  Separation best_ = {Vector3d::UnitZ(), std::numeric_limits<double>::infinity()};
};

/// The hull of the parts of one shape.
PointHull hullOf(const ContactShape& shape, const std::vector<ShapeParts>& parts, std::uint32_t ShapeParts::*of_shape)
{
  std::vector<Vector3d> points;
  for (const ShapeParts& part : parts)
    for (const Vector3d& vertex : placedTriangle(shape, part.*of_shape))
      points.push_back(vertex);
  return PointHull(std::move(points));
}

/// The direction that is best for the hulls of the parts that meet.
Vector3d directionOfParts(const ContactPair& pair, const std::vector<ShapeParts>& parts)
{
  if (!pair.a.tree->mesh)
    return separationOf(ShapeHull(*pair.a.tree, pair.a.pose), hullOf(pair.b, parts, &ShapeParts::of_b)).normal;
  const PointHull a = hullOf(pair.a, parts, &ShapeParts::of_a);
  return (pair.b.tree->mesh ? separationOf(a, hullOf(pair.b, parts, &ShapeParts::of_b))
                            : separationOf(a, ShapeHull(*pair.b.tree, pair.b.pose)))
      .normal;
}

/// Normals of the largest triangles that meet the other shape, at most kMaxFaceNormals that differ clearly.
std::vector<Vector3d> faceNormals(const ContactShape& shape, const std::vector<ShapeParts>& parts,
                                  std::uint32_t ShapeParts::*of_shape)
{
  if (!shape.tree->mesh)
    return {};
  std::vector<Vector3d> normals;
  for (const ShapeParts& part : parts)
  {
    const Triangle t = placedTriangle(shape, part.*of_shape);
    normals.push_back((t[1] - t[0]).cross(t[2] - t[0]));
  }
  std::stable_sort(normals.begin(), normals.end(),
                   [](const Vector3d& a, const Vector3d& b) { return a.squaredNorm() > b.squaredNorm(); });
  constexpr double kClearlyDifferent = 0.99;  // cosine of 8 degrees
  std::vector<Vector3d> kept;
  for (const Vector3d& normal : normals)
  {
    const double length = normal.norm();
    if (kept.size() == kMaxFaceNormals || !(length > 0.0))
      break;
    const Vector3d unit = normal / length;
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Vector3d& other) { return other.dot(unit) > kClearlyDifferent; }))
      kept.push_back(unit);
  }
  return kept;
}
}  // namespace

std::vector<ShapeParts> meetingParts(const ContactPair& pair, std::size_t most, CpuShapePair::Scratch& scratch)
{
  const ContactShape& a = pair.a;
  const ContactShape& b = pair.b;
  if (!a.tree->mesh && !b.tree->mesh)
    return {};
  std::vector<ShapeParts> parts = crossingsOf(a, b, 0.0, most);
  if (!parts.empty())
    return parts;
  const double farthest = a.tree->half.norm() + b.tree->half.norm() + pair.required;
  const double distance = pairClearance(*a.tree, a.pose, *b.tree, b.pose, 0.0, farthest, scratch).clearance;
  return crossingsOf(a, b, distance + kDistanceAccuracy, most);
}

Separation findSeparation(const std::vector<ContactPair>& pairs, const std::vector<std::size_t>& colliding,
                          const CpuShapePair& exact, CpuShapePair::Scratch& scratch)
{
  TranslationSearch search(pairs, exact, scratch);
  if (pairs.size() == 1)
  {
    const ContactPair& pair = pairs.front();
    const ConvexSeparation hulls = hullSeparation(pair.a, pair.b);
    search.offerProven(hulls.normal, hulls.depth + pair.required + kSeparationGap);
    if (pair.a.is_convex && pair.b.is_convex)
      return search.best();
  }
  else
  {
    search.offerAxis();
  }
  for (std::size_t i = 0; i < std::min(colliding.size(), kMaxPairs); ++i)
  {
    const ContactPair& pair = pairs[colliding[i]];
    search.offer(hullSeparation(pair.a, pair.b).normal);
    const std::vector<ShapeParts> parts = meetingParts(pair, kMaxMeetingParts, scratch);
    if (parts.empty())
      continue;
    const Vector3d between = directionOfParts(pair, parts);
    for (const double sign : {1.0, -1.0})
    {
      search.offer(sign * between);
      for (const Vector3d& normal : faceNormals(pair.a, parts, &ShapeParts::of_a))
        search.offer(sign * normal);
      for (const Vector3d& normal : faceNormals(pair.b, parts, &ShapeParts::of_b))
        search.offer(-sign * normal);
    }
  }
  return search.best();
}
}  // namespace gpu_planning_scene::core
