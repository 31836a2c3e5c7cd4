#include "oracle/convex.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "oracle/oracle.h"
#include "oracle/triangle.h"

namespace gpu_planning_scene::core::oracle
{
namespace
{
constexpr int kMaxSteps = 2000;

Quad signedHalf(double size, Quad direction)
{
  return direction < 0 ? -Quad(size) / 2 : Quad(size) / 2;
}

/// The point of a circle around z that is farthest in a direction.
Vector onCircle(double radius, const Vector& direction, Quad z)
{
  const Quad across = sqrt(direction.x * direction.x + direction.y * direction.y);
  if (!(across > 0))
    return {0, 0, z};
  const Quad factor = radius / across;
  return {factor * direction.x, factor * direction.y, z};
}

Vector farthestCore(const Box& box, const Vector& d)
{
  return {signedHalf(box.size.x(), d.x), signedHalf(box.size.y(), d.y), signedHalf(box.size.z(), d.z)};
}

Vector farthestCore(const Sphere&, const Vector&)
{
  return {};
}

Vector farthestCore(const Cylinder& cylinder, const Vector& d)
{
  return onCircle(cylinder.radius, d, signedHalf(cylinder.length, d.z));
}

Vector farthestCore(const Cone& cone, const Vector& d)
{
  const Vector apex(0, 0, Quad(cone.length) / 2);
  const Vector rim = onCircle(cone.radius, d, -Quad(cone.length) / 2);
  return dot(d, apex) > dot(d, rim) ? apex : rim;
}

Vector farthestCore(const Corners& triangle, const Vector& d)
{
  return *std::max_element(
      triangle.corners.begin(), triangle.corners.end(),
      [&](const Vector& p, const Vector& q) { return dot(d, p) < dot(d, q); });
}

Vector farthestCore(const Convex& convex, const Vector& direction)
{
  return std::visit([&](const auto& shape) { return farthestCore(shape, direction); }, convex);
}

Quad radiusOf(const Convex& convex)
{
  const auto* sphere = std::get_if<Sphere>(&convex);
  return sphere ? Quad(sphere->radius) : Quad(0);
}

/// At most four points of the difference of the two sets. The search looks for the point of their convex hull that is
/// nearest to the origin.
using Simplex = std::vector<Vector>;

bool originInside(const Simplex& tetrahedron)
{
  for (int i = 0; i < 4; ++i)
  {
    const Vector& p = tetrahedron[(i + 1) % 4];
    const Vector normal = cross(tetrahedron[(i + 2) % 4] - p, tetrahedron[(i + 3) % 4] - p);
    const Quad own_side = dot(normal, tetrahedron[i] - p);
    const Quad origin_side = -dot(normal, p);
    if (own_side == 0 || (own_side > 0 ? origin_side < 0 : origin_side > 0))
      return false;
  }
  return true;
}

/// The point nearest to the origin of a simplex of up to three points. Reduces `simplex` to the
/// points whose convex hull contains the nearest point.
Vector nearestOfFace(Simplex& simplex)
{
  const Simplex all = simplex;
  Vector best = all[0];
  simplex = {all[0]};
  const auto consider = [&](const Vector& candidate, Simplex between)
  {
    if (squaredLength(candidate) < squaredLength(best))
    {
      best = candidate;
      simplex = std::move(between);
    }
  };
  for (std::size_t i = 1; i < all.size(); ++i)
    consider(all[i], {all[i]});
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    for (std::size_t k = 0; k < i; ++k)
    {
      const Vector along = all[k] - all[i];
      const Quad squared = squaredLength(along);
      const Quad at = squared > 0 ? -dot(all[i], along) / squared : Quad(0);
      if (at > 0 && at < 1)
        consider(all[i] + at * along, {all[i], all[k]});
    }
  }
  if (all.size() == 3)
  {
    const Triangle face({all[0], all[1], all[2]});
    const auto inside = [&](int i) { return dot(face.inward[i], all[i]) < 0; };
    if (face.has_face && inside(0) && inside(1) && inside(2))
      consider(dot(face.normal, all[0]) * face.normal, all);
  }
  return best;
}

/// As nearestOfFace() for up to four points. A tetrahedron that contains the origin is not reduced.
Vector nearestToOrigin(Simplex& simplex)
{
  if (simplex.size() < 4)
    return nearestOfFace(simplex);
  if (originInside(simplex))
    return {};
  const Simplex all = simplex;
  Vector best;
  for (int left_out = 0; left_out < 4; ++left_out)
  {
    Simplex face = all;
    face.erase(face.begin() + left_out);
    const Vector candidate = nearestOfFace(face);
    if (left_out == 0 || squaredLength(candidate) < squaredLength(best))
    {
      best = candidate;
      simplex = face;
    }
  }
  return best;
}
}  // namespace

Bounds convexDistance(const Convex& a, const Motion& pose_a, const Convex& b, const Motion& pose_b, Quad required,
                      Quad enough)
{
  const Quad radii = radiusOf(a) + radiusOf(b);
  // The farthest point of the difference of the two sets in a direction.
  const auto farthest = [&](const Vector& d)
  { return pose_a * farthestCore(a, pose_a.unrotate(d)) - pose_b * farthestCore(b, pose_b.unrotate(-d)); };
  Simplex simplex = {farthest(pose_b.translation - pose_a.translation + Vector(1, 0, 0))};
  Vector nearest = simplex[0];
  Bounds bounds{0, 0};
  for (int step = 0; step < kMaxSteps; ++step)
  {
    const Quad core = length(nearest);
    bounds.upper = std::max(Quad(0), core - radii);
    // The sets have a common point, up to the rounding of quadruple precision.
    if (bounds.upper <= Quad(1e-25))
      return {0, 0};
    const Vector next = farthest(-nearest);
    bounds.lower = std::max(bounds.lower, dot(nearest, next) / core - radii);
    if (bounds.upper <= required || bounds.lower > enough || bounds.upper - bounds.lower < Quad(kAccuracy))
      return bounds;
    simplex.push_back(next);
    nearest = nearestToOrigin(simplex);
  }
  throw std::logic_error("oracle: the distance of two convex sets was not found");
}

Vector farthestPoint(const Convex& convex, const Vector& direction)
{
  const Quad radius = radiusOf(convex);
  const Vector core = farthestCore(convex, direction);
  return radius > 0 ? core + (radius / length(direction)) * direction : core;
}
}  // namespace gpu_planning_scene::core::oracle
