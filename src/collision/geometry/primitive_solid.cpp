#include "collision/geometry/primitive_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/math_constants.h"
#include "collision/geometry/convex_pair.h"
#include "collision/geometry/precise_distance.h"

// Spheres are decided by the distance of a point from a shape (Ericson, "Real-Time Collision Detection", 2005, 5.1).
// The other primitives have support functions and are decided by convexWithin (Gilbert, Johnson and Keerthi 1988). Most
// triangles do not need it: they are beside the solid, or have a vertex in it.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;

template <class... Functions>
struct Overloaded : Functions...
{
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// The vector from the nearest point of a cylinder or cone to a point; 0 inside. The radius is linear in z, so the
/// search takes place in the half plane that is spanned by the axis and the point: x is the distance from the axis, y
/// is z.
Vector3d fromFrustum(double bottom_radius, double top_radius, double half_length, const Vector3d& point)
{
  const Vector2d p(point.head<2>().norm(), point.z());
  const double radius = bottom_radius + (top_radius - bottom_radius) * (p.y() + half_length) / (2.0 * half_length);
  if (std::abs(p.y()) <= half_length && p.x() <= radius)
    return Vector3d::Zero();
  Vector2d best = Vector2d::Constant(std::numeric_limits<double>::infinity());
  const auto offer_segment = [&p, &best](const Vector2d& start, const Vector2d& end)
  {
    const Vector2d step = end - start;
    const double length = step.squaredNorm();
    const double t = length > 0.0 ? std::clamp((p - start).dot(step) / length, 0.0, 1.0) : 0.0;
    const Vector2d offset = p - (start + t * step);
    best = offset.squaredNorm() < best.squaredNorm() ? offset : best;
  };
  const Vector2d bottom(bottom_radius, -half_length);
  const Vector2d top(top_radius, half_length);
  offer_segment(bottom, top);
  offer_segment(Vector2d(0.0, -half_length), bottom);
  offer_segment(Vector2d(0.0, half_length), top);
  const Vector2d outward = p.x() > 0.0 ? Vector2d(point.head<2>() / p.x()) : Vector2d::UnitX();
  return {best.x() * outward.x(), best.x() * outward.y(), best.y()};
}

/// The vector from the nearest point of a box, cylinder or cone to a point; 0 inside.
Vector3d fromSolid(const Shape& solid, const Vector3d& point)
{
  return std::visit(
      Overloaded{[&](const Box& box) -> Vector3d
                 { return point - point.cwiseMin(0.5 * box.size).cwiseMax(-0.5 * box.size); },
                 [&](const Cylinder& c) { return fromFrustum(c.radius, c.radius, 0.5 * c.length, point); },
                 [&](const Cone& c) { return fromFrustum(c.radius, 0.0, 0.5 * c.length, point); },
                 [](const auto& /*no primitive*/) -> Vector3d
                 { return Vector3d::Constant(std::numeric_limits<double>::infinity()); }},
      solid);
}

/// The distance of a point from the surface of a cylinder or cone; below 0 outside.
double depthInFrustum(double bottom_radius, double top_radius, double half_length, const Vector3d& point)
{
  const double slope = (top_radius - bottom_radius) / (2.0 * half_length);
  const double radius = bottom_radius + slope * (point.z() + half_length);
  return std::min((radius - point.head<2>().norm()) / std::sqrt(1.0 + slope * slope),
                  half_length - std::abs(point.z()));
}

/// The point of a disk around the z axis that is farthest along a direction.
Vector3d farthestOfDisk(double radius, double z, const Vector3d& direction)
{
  const double across = direction.head<2>().norm();
  const double scale = across > 0.0 ? radius / across : 0.0;
  return {scale * direction.x(), scale * direction.y(), z};
}

class ConvexTriangle final : public Convex
{
 public:
  explicit ConvexTriangle(const Triangle& triangle)
    : triangle_(triangle), center_((triangle[0] + triangle[1] + triangle[2]) / 3.0)
  {
    radius_ = std::sqrt(std::max({(triangle[0] - center_).squaredNorm(), (triangle[1] - center_).squaredNorm(),
                                  (triangle[2] - center_).squaredNorm()}));
  }

  Vector3d farthest(const Vector3d& direction) const override
  {
    const double first = direction.dot(triangle_[0]);
    const double second = direction.dot(triangle_[1]);
    const double third = direction.dot(triangle_[2]);
    return first >= second ? triangle_[first >= third ? 0 : 2] : triangle_[second >= third ? 1 : 2];
  }
  Vector3d center() const override { return center_; }
  double radius() const override { return radius_; }

 private:
  const Triangle& triangle_;
  Vector3d center_;
  double radius_;
};

class ConvexSolid final : public Convex
{
 public:
  explicit ConvexSolid(const Shape& solid) : solid_(solid), radius_(halfExtents(solid).norm()) {}

  Vector3d farthest(const Vector3d& direction) const override { return farthestOfSolid(solid_, direction); }
  Vector3d center() const override { return Vector3d::Zero(); }
  double radius() const override { return radius_; }

 private:
  const Shape& solid_;
  double radius_;
};

class PlacedConvexSolid final : public Convex
{
 public:
  PlacedConvexSolid(const Shape& solid, const Eigen::Isometry3d& pose)
    : solid_(solid), pose_(pose), radius_(halfExtents(solid).norm())
  {
  }

  Vector3d farthest(const Vector3d& direction) const override
  {
    return pose_ * farthestOfSolid(solid_, pose_.linear().transpose() * direction);
  }
  Vector3d center() const override { return pose_.translation(); }
  double radius() const override { return radius_; }

 private:
  const Shape& solid_;
  const Eigen::Isometry3d& pose_;
  double radius_;
};

/// Whether the whole triangle is more than `distance` beyond one face of the box along the axes with these half lengths
/// around the origin.
bool isBesideBox(const Triangle& triangle, const Vector3d& half, double distance)
{
  const Vector3d low = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
  const Vector3d high = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
  return (low.cwiseMax(-high) - half).maxCoeff() > distance;
}

/// Whether the distance between the point and the triangle is at most `distance`.
bool triangleWithinPoint(const Triangle& triangle, const Vector3d& point, double distance)
{
  const double found = (nearestPoint(triangle, point) - point).norm();
  double size = point.lpNorm<Eigen::Infinity>();
  for (const Vector3d& vertex : triangle)
    size = std::max({size, vertex.lpNorm<Eigen::Infinity>(), (vertex - point).lpNorm<Eigen::Infinity>()});
  const double rounding = 16.0 * kEpsilon * size;
  if (found + rounding <= distance)
    return true;  // certain: `found` is the distance of a point of the triangle
  if (found - rounding * (1.0 + size / distance) > distance)
    return false;  // certain: the error of nearestPoint shrinks as the distance grows
  return preciseDistance(triangle, point) <= distance;
}
}  // namespace

bool isMesh(const Shape& shape)
{
  return std::holds_alternative<std::shared_ptr<const Mesh>>(shape);
}

Vector3d halfExtents(const Shape& solid)
{
  return std::visit(Overloaded{[](const Box& box) -> Vector3d { return 0.5 * box.size; },
                               [](const Sphere& sphere) -> Vector3d { return Vector3d::Constant(sphere.radius); },
                               [](const Cylinder& c) { return Vector3d(c.radius, c.radius, 0.5 * c.length); },
                               [](const Cone& c) { return Vector3d(c.radius, c.radius, 0.5 * c.length); },
                               [](const auto& /*no primitive*/) { return Vector3d(0.0, 0.0, 0.0); }},
                    solid);
}

Vector3d vectorFromSolid(const Shape& solid, const Vector3d& point)
{
  if (const Sphere* sphere = std::get_if<Sphere>(&solid))
  {
    const double length = point.norm();
    return length > sphere->radius ? Vector3d((1.0 - sphere->radius / length) * point) : Vector3d::Zero();
  }
  return fromSolid(solid, point);
}

double depthInSolid(const Shape& solid, const Vector3d& point)
{
  return std::max(
      0.0, std::visit(
               Overloaded{[&](const Box& box) { return (0.5 * box.size - point.cwiseAbs()).minCoeff(); },
                          [&](const Sphere& sphere) { return sphere.radius - point.norm(); },
                          [&](const Cylinder& c) { return depthInFrustum(c.radius, c.radius, 0.5 * c.length, point); },
                          [&](const Cone& c) { return depthInFrustum(c.radius, 0.0, 0.5 * c.length, point); },
                          [](const auto& /*no primitive*/) { return 0.0; }},
               solid));
}

double distanceToSolid(const Shape& solid, const Vector3d& point)
{
  if (const Sphere* sphere = std::get_if<Sphere>(&solid))
    return std::max(0.0, point.norm() - sphere->radius);
  return fromSolid(solid, point).norm();
}

double distanceToSolid(const Shape& solid, const Triangle& triangle)
{
  if (const Sphere* sphere = std::get_if<Sphere>(&solid))
    return std::max(0.0, nearestPoint(triangle, Vector3d::Zero()).norm() - sphere->radius);
  const ConvexTriangle convex(triangle);
  return convexDistance(convex, ConvexSolid(solid), convex.center());
}

double distanceOfSolids(const Shape& a, const Shape& b, const Eigen::Isometry3d& b_in_a)
{
  if (const Sphere* sphere = std::get_if<Sphere>(&b))
    return std::max(0.0, distanceToSolid(a, b_in_a.translation()) - sphere->radius);
  if (const Sphere* sphere = std::get_if<Sphere>(&a))
    return std::max(0.0, distanceToSolid(b, b_in_a.inverse().translation()) - sphere->radius);
  return convexDistance(ConvexSolid(a), PlacedConvexSolid(b, b_in_a), -b_in_a.translation());
}

Vector3d farthestOfSolid(const Shape& solid, const Vector3d& direction)
{
  return std::visit(
      Overloaded{[&](const Box& box) -> Vector3d
                 {
                   const Vector3d half = 0.5 * box.size;
                   return {std::copysign(half.x(), direction.x()), std::copysign(half.y(), direction.y()),
                           std::copysign(half.z(), direction.z())};
                 },
                 [&](const Cylinder& c)
                 { return farthestOfDisk(c.radius, std::copysign(0.5 * c.length, direction.z()), direction); },
                 [&](const Cone& c)
                 {
                   const Vector3d base = farthestOfDisk(c.radius, -0.5 * c.length, direction);
                   const Vector3d apex(0.0, 0.0, 0.5 * c.length);
                   return direction.dot(apex - base) > 0.0 ? apex : base;
                 },
                 [&](const Sphere& sphere) -> Vector3d
                 {
                   const double length = direction.norm();
                   return length > 0.0 ? Vector3d(sphere.radius / length * direction) : Vector3d::Zero();
                 },
                 [](const auto& /*no primitive*/) -> Vector3d { return Vector3d::Zero(); }},
      solid);
}

double reachAlong(const Shape& solid, const Vector3d& direction)
{
  return direction.dot(farthestOfSolid(solid, direction));
}

bool triangleWithinSolid(const Triangle& triangle, const Shape& solid, double required, SeparatingAxis* axis)
{
  const double distance = required + kSlack;
  if (const Sphere* sphere = std::get_if<Sphere>(&solid))
    return triangleWithinPoint(triangle, Vector3d::Zero(), sphere->radius + distance);
  // Rounding is monotone, so a gap of at most `required` never counts as larger than `distance`.
  if (isBesideBox(triangle, halfExtents(solid), distance))
    return false;
  if (std::any_of(triangle.begin(), triangle.end(),
                  [&](const Vector3d& vertex) { return fromSolid(solid, vertex).norm() <= required; }))
    return true;
  const Triangle sorted = sortedTriangle(triangle);
  const ConvexTriangle convex(sorted);
  const Vector3d to_center = fromSolid(solid, convex.center());
  const double from_center = to_center.norm();
  if (from_center <= required)
    return true;
  return from_center <= convex.radius() + 2.0 * distance &&
         convexWithin(convex, ConvexSolid(solid), distance, to_center, axis);
}

bool solidsWithin(const Shape& a, const Shape& b, const Eigen::Isometry3d& b_in_a, double required)
{
  const double distance = required + kSlack;
  if (const Sphere* sphere = std::get_if<Sphere>(&b))
    return distanceToSolid(a, b_in_a.translation()) <= sphere->radius + distance;
  if (const Sphere* sphere = std::get_if<Sphere>(&a))
    return distanceToSolid(b, b_in_a.inverse().translation()) <= sphere->radius + distance;
  return convexWithin(ConvexSolid(a), PlacedConvexSolid(b, b_in_a), distance, -b_in_a.translation());
}
}  // namespace gpu_planning_scene::core
