#include "primitive_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gpu_planning_scene
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// A cylinder or a cone: the radius is linear in z.
struct Frustum
{
  double bottom_radius;  // at z = -half_length
  double top_radius;     // at z = +half_length
  double half_length;

  double radiusAt(double z) const
  {
    return bottom_radius + (top_radius - bottom_radius) * (z + half_length) / (2.0 * half_length);
  }
};

/// Grown by the contact tolerance, so that rounding does not lose a contact.
Frustum grown(const Frustum& frustum)
{
  return {frustum.bottom_radius + kContactTolerance, frustum.top_radius + kContactTolerance,
          frustum.half_length + kContactTolerance};
}

Frustum frustumOf(const Cylinder& cylinder)
{
  return {cylinder.radius, cylinder.radius, 0.5 * cylinder.length};
}
Frustum frustumOf(const Cone& cone)
{
  return {cone.radius, 0.0, 0.5 * cone.length};
}

bool segmentMeets(const Vector3d& start, const Vector3d& end, const Frustum& frustum)
{
  const Vector3d step = end - start;
  double first = 0.0;
  double last = 1.0;
  if (step.z() == 0.0)
  {
    if (std::abs(start.z()) > frustum.half_length)
    {
      return false;
    }
  }
  else
  {
    const double at_bottom = (-frustum.half_length - start.z()) / step.z();
    const double at_top = (frustum.half_length - start.z()) / step.z();
    first = std::max(first, std::min(at_bottom, at_top));
    last = std::min(last, std::max(at_bottom, at_top));
    if (first > last)
    {
      return false;
    }
  }
  // Inside where g(t) = x^2 + y^2 - radius(z)^2 <= 0. Between the planes the radius is not negative, so the minimum of
  // the quadratic g over [first, last] decides.
  const double slope = (frustum.top_radius - frustum.bottom_radius) / (2.0 * frustum.half_length) * step.z();
  const double radius = frustum.radiusAt(start.z());
  const auto meets_at = [&](double t) { return (start.head<2>() + t * step.head<2>()).norm() <= radius + t * slope; };
  const double curvature = step.head<2>().squaredNorm() - slope * slope;
  const double half_linear = start.head<2>().dot(step.head<2>()) - radius * slope;
  const double lowest = curvature > 0.0 ? std::clamp(-half_linear / curvature, first, last) : first;
  return meets_at(lowest) || meets_at(first) || meets_at(last);
}

bool triangleMeetsFrustum(const Triangle& triangle, const Frustum& exact)
{
  const Frustum frustum = grown(exact);
  for (int i = 0; i < 3; ++i)
  {
    if (segmentMeets(triangle[i], triangle[(i + 1) % 3], frustum))
    {
      return true;
    }
  }
  // No edge meets the solid. If the triangle does, it contains the whole cut of its plane through the solid, and so any
  // point of that cut. The section of the solid that holds its axis and the plane's normal reaches as far to both sides
  // of the plane as the solid does, so the plane cuts an edge of that section if it cuts the solid.
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double across = normal.head<2>().norm();
  const Vector2d u = across > 0.0 ? Vector2d(normal.head<2>() / across) : Vector2d::UnitX();
  const double b = frustum.bottom_radius;
  const double t = frustum.top_radius;
  const double h = frustum.half_length;
  const std::array<Vector3d, 4> section = {Vector3d(b * u.x(), b * u.y(), -h), Vector3d(t * u.x(), t * u.y(), h),
                                           Vector3d(-t * u.x(), -t * u.y(), h), Vector3d(-b * u.x(), -b * u.y(), -h)};
  for (int i = 0; i < 4; ++i)
  {
    const Vector3d& start = section[i];
    const Vector3d& end = section[(i + 1) % 4];
    const double start_side = normal.dot(start - triangle[0]);
    const double end_side = normal.dot(end - triangle[0]);
    if ((start_side > 0.0) == (end_side > 0.0))
    {
      continue;
    }
    const Vector3d cut = start + start_side / (start_side - end_side) * (end - start);
    bool inside = true;
    for (int j = 0; j < 3; ++j)
    {
      const Vector3d& corner = triangle[j];
      inside = inside && normal.dot((triangle[(j + 1) % 3] - corner).cross(cut - corner)) >= 0.0;
    }
    return inside;
  }
  return false;
}

/// Separating axes of a box and a triangle, after Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing" (2001).
bool triangleMeetsBox(const Triangle& triangle, const Vector3d& half)
{
  double size = half.maxCoeff();
  for (const Vector3d& vertex : triangle)
  {
    size = std::max(size, vertex.lpNorm<Eigen::Infinity>());
  }
  const auto separates = [&](const Vector3d& axis)
  {
    const double p0 = axis.dot(triangle[0]);
    const double p1 = axis.dot(triangle[1]);
    const double p2 = axis.dot(triangle[2]);
    const Vector3d reach = axis.cwiseAbs();
    const double tolerance = kContactTolerance * reach.sum();
    const double radius = half.dot(reach) + tolerance;
    return std::min({p0, p1, p2}) > radius || std::max({p0, p1, p2}) < -radius;
  };
  for (int i = 0; i < 3; ++i)
  {
    if (separates(Vector3d::Unit(i)))
    {
      return false;
    }
  }
  const std::array<Vector3d, 3> edges = {triangle[1] - triangle[0], triangle[2] - triangle[1],
                                         triangle[0] - triangle[2]};
  const auto usable = [&](const Vector3d& axis, double scale)
  { return axis.lpNorm<Eigen::Infinity>() > 1e3 * kEpsilon * scale; };
  const Vector3d normal = edges[0].cross(edges[1]);
  if (usable(normal, edges[0].norm() * edges[1].norm()) && separates(normal))
  {
    return false;
  }
  for (const Vector3d& edge : edges)
  {
    for (int i = 0; i < 3; ++i)
    {
      const Vector3d axis = Vector3d::Unit(i).cross(edge);
      if (usable(axis, edge.norm()) && separates(axis))
      {
        return false;
      }
    }
  }
  return true;
}

/// The distance of a point from a convex polygon's corners in the half plane of distance from the axis and z.
double distanceToFrustum(const Frustum& frustum, const Vector3d& point)
{
  const double h = frustum.half_length;
  const Vector2d p(point.head<2>().norm(), point.z());
  const auto to_segment = [&p](const Vector2d& start, const Vector2d& end)
  {
    const Vector2d step = end - start;
    const double length = step.squaredNorm();
    const double t = length > 0.0 ? std::clamp((p - start).dot(step) / length, 0.0, 1.0) : 0.0;
    return (start + t * step - p).norm();
  };
  if (std::abs(p.y()) <= h && p.x() <= frustum.radiusAt(p.y()))
  {
    return 0.0;
  }
  const Vector2d bottom(frustum.bottom_radius, -h);
  const Vector2d top(frustum.top_radius, h);
  return std::min({to_segment(bottom, top), to_segment(Vector2d(0.0, -h), bottom), to_segment(Vector2d(0.0, h), top)});
}

template <class... Functions>
struct Overloaded : Functions...
{
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

using MeshPointer = std::shared_ptr<const Mesh>;
}  // namespace

bool isMesh(const Shape& shape)
{
  return std::holds_alternative<MeshPointer>(shape);
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

double distanceToSolid(const Shape& solid, const Vector3d& point)
{
  return std::visit(Overloaded{[&](const Box& box) { return (point.cwiseAbs() - 0.5 * box.size).cwiseMax(0.0).norm(); },
                               [&](const Sphere& sphere) { return std::max(0.0, point.norm() - sphere.radius); },
                               [&](const Cylinder& cylinder) { return distanceToFrustum(frustumOf(cylinder), point); },
                               [&](const Cone& cone) { return distanceToFrustum(frustumOf(cone), point); },
                               [](const auto& /*no primitive*/) { return std::numeric_limits<double>::infinity(); }},
                    solid);
}

bool triangleMeetsSolid(const Triangle& triangle, const Shape& solid)
{
  return std::visit(
      Overloaded{[&](const Box& box) { return triangleMeetsBox(triangle, 0.5 * box.size); },
                 [&](const Sphere& sphere)
                 { return nearestPoint(triangle, Vector3d::Zero()).norm() <= sphere.radius + kContactTolerance; },
                 [&](const Cylinder& cylinder) { return triangleMeetsFrustum(triangle, frustumOf(cylinder)); },
                 [&](const Cone& cone) { return triangleMeetsFrustum(triangle, frustumOf(cone)); },
                 [](const auto& /*no primitive*/) { return false; }},
      solid);
}
}  // namespace gpu_planning_scene
