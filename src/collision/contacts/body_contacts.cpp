#include "collision/contacts/body_contacts.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "collision/contacts/crossings.h"
#include "collision/contacts/separation_search.h"
#include "collision/geometry/cpu_box_pair.h"

// The translation that separates the bodies gives the normal and the depth. The points are in both bodies: the middle
// between the points of the hulls that are deepest in the other shape if it is in both shapes, and points where the
// surfaces cross otherwise. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d middleOf(const std::array<Vector3d, 2>& points)
{
  return 0.5 * (points[0] + points[1]);
}

/// The point between a point of both shapes and `goal` that is nearest to the goal and in both shapes.
Vector3d towards(const ContactPair& pair, const Vector3d& in_both, const Vector3d& goal)
{
  const auto at = [&](double share) { return Vector3d(in_both + share * (goal - in_both)); };
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 20; ++i)
  {
    const double middle = 0.5 * (low + high);
    const Vector3d point = at(middle);
    (contains(pair.a, point) && contains(pair.b, point) ? low : high) = middle;
  }
  return at(low);
}

/// A point of the inner shape if one shape is inside the other.
std::optional<Vector3d> pointInside(const ContactShape& outer, const ContactShape& inner)
{
  if (!inner.tree->mesh && contains(outer, inner.pose.translation()))
    return inner.pose.translation();
  for (const Component& component : componentsOf(*inner.tree))
    if (contains(outer, inner.pose * component.point))
      return inner.pose * component.point;
  return std::nullopt;
}

/// The point where two shapes overlap most: a point of both, or the middle between their nearest points if they only
/// miss their required distance.
Vector3d deepestPoint(const ContactPair& pair, CpuShapePair::Scratch& scratch)
{
  const ContactShape& a = pair.a;
  const ContactShape& b = pair.b;
  const ConvexSeparation hulls = hullSeparation(a, b);
  Vector3d middle = 0.5 * (hulls.on_a + hulls.on_b);
  if (a.is_convex && b.is_convex && hulls.depth <= 0.0)
    return middle;
  for (const Vector3d& point : {middle, hulls.on_b, hulls.on_a})
    if (contains(a, point) && contains(b, point))
      return point;
  if (a.is_convex && b.is_convex)
  {
    const Vector3d in_both = a.pose * commonPoint(ShapeHull(*a.tree, Isometry3d::Identity()),
                                                  ShapeHull(*b.tree, relativePose(a.pose, b.pose)));
    if (contains(a, in_both) && contains(b, in_both))
      return towards(pair, in_both, middle);
  }
  if (const auto inner = pointInside(a, b))
    return *inner;
  if (const auto inner = pointInside(b, a))
    return *inner;
  // Of the points where the surfaces meet, the one that is nearest to their mean.
  std::vector<Vector3d> points;
  Vector3d sum = Vector3d::Zero();
  for (const ShapeParts& part : meetingParts(pair, kMaxOfPair, scratch))
  {
    points.push_back(middleOf(pointsOf(a, b, part)));
    sum += points.back();
  }
  if (points.empty())
    return middle;
  const Vector3d mean = sum / static_cast<double>(points.size());
  return *std::min_element(points.begin(), points.end(),
                           [&mean](const Vector3d& p, const Vector3d& q)
                           { return (p - mean).squaredNorm() < (q - mean).squaredNorm(); });
}

/// Points where the surfaces of two shapes cross. The surfaces of round primitives have no exact triangles, so they
/// give none.
std::vector<Vector3d> crossingPoints(const ContactPair& pair, std::size_t most)
{
  const auto is_box = [](const ContactShape& shape) { return std::holds_alternative<Box>(shape.tree->shape); };
  std::vector<ShapeParts> parts;
  if (pair.a.tree->mesh || pair.b.tree->mesh)
    parts = crossingsOf(pair.a, pair.b, 0.0, most);
  else if (is_box(pair.a) && is_box(pair.b))
    parts = crossingsOfBoxes(pair.a, pair.b, most);
  std::vector<Vector3d> points;
  for (const ShapeParts& part : parts)
    points.push_back(middleOf(pointsOf(pair.a, pair.b, part)));
  return points;
}
}  // namespace

std::vector<ShapeContact> contactsOf(const std::vector<ContactPair>& pairs, const std::vector<std::size_t>& colliding,
                                     const CpuShapePair& exact, CpuShapePair::Scratch& scratch, std::size_t most)
{
  const Separation separation = findSeparation(pairs, colliding, exact, scratch);
  const auto overlap_of = [&](std::size_t i)
  {
    const ContactPair& pair = pairs[i];
    return reachOf(pair.a, separation.normal) + reachOf(pair.b, -separation.normal) + pair.required;
  };
  const std::size_t deepest = *std::max_element(
      colliding.begin(), colliding.end(), [&](std::size_t i, std::size_t j) { return overlap_of(i) < overlap_of(j); });
  std::vector<ShapeContact> contacts = {{deepestPoint(pairs[deepest], scratch), separation.normal, separation.depth}};
  for (const std::size_t i : colliding)
  {
    if (contacts.size() >= most)
      break;
    for (const Vector3d& point : crossingPoints(pairs[i], most - contacts.size()))
      contacts.push_back({point, separation.normal, separation.depth});
  }
  return contacts;
}

ShapeContact contactWithHalfSpace(const ContactShape& a, const PlacedHalfSpace& b, double required)
{
  const Vector3d down = -b.normal;
  const Vector3d point = ShapeHull(*a.tree, a.pose).farthest(down) + sphereRadius(*a.tree) * down;
  const double depth = b.offset + required - b.normal.dot(point);
  return {point, down, std::max(0.0, depth) + kSeparationGap};
}

double leastDepthOf(const ContactPair& pair, const Vector3d& point)
{
  const ConvexSeparation hulls = hullSeparation(pair.a, pair.b);
  double depth = 0.0;
  if (pair.a.is_convex && pair.b.is_convex)
  {
    constexpr double kErrorPerSize = 1e-9;  // of a mesh that counts as convex
    const double sizes = pair.a.tree->half.norm() + pair.b.tree->half.norm();
    depth = std::max(0.0, hulls.least_depth + pair.required - kErrorPerSize * sizes);
  }
  // A ball around a point of both shapes is in each of them. They overlap until one has moved by the sum of the radii.
  for (const Vector3d& tried : {point, hulls.on_a, hulls.on_b, Vector3d(0.5 * (hulls.on_a + hulls.on_b))})
    if (contains(pair.a, tried) && contains(pair.b, tried))
      depth = std::max(depth, depthInside(pair.a, tried) + depthInside(pair.b, tried) + pair.required - 2.0 * kOnShape);
  return depth;
}

std::array<Vector3d, 2> nearestPointsOf(const ContactShape& a, const ContactShape& b, double distance)
{
  constexpr double kDistanceError = 1.1e-6;  // metres; exceeds the error of `distance`
  if (a.is_convex && b.is_convex)
  {
    const ConvexSeparation hulls = hullSeparation(a, b);
    return {hulls.on_a, hulls.on_b};
  }
  CpuShapePair::Scratch scratch;
  const auto parts = pairClearance(*a.tree, a.pose, *b.tree, b.pose, 0.0, distance + kDistanceError, scratch).parts;
  const Vector3d none = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return parts ? nearestPointsOf(a, b, *parts) : std::array<Vector3d, 2>{none, none};
}

std::array<Vector3d, 2> nearestPointsOf(const ContactShape& a, const ContactShape& b, const ShapeParts& parts)
{
  if (parts.of_a != ShapeParts::kWhole || parts.of_b != ShapeParts::kWhole)
    return pointsOf(a, b, parts);
  const ConvexSeparation hulls = hullSeparation(a, b);
  return {hulls.on_a, hulls.on_b};
}
}  // namespace gpu_planning_scene::core
