// Part of the lane kernel, see lane_kernel_body.h: distances of eight points from points and solids.
#pragma once

#include "collision/cpu/lanes/lane_kinematics.h"

namespace gpu_planning_scene::core::lanes
{
namespace
{
/// NaN stays NaN, so that it proves nothing.
inline Floats atLeastZero(const Floats& x)
{
  return larger(all(0.0F), x);
}

inline Floats squaredDistance(const Points& a, const Points& b)
{
  const Floats x = a.x - b.x;
  const Floats y = a.y - b.y;
  const Floats z = a.z - b.z;
  return x * x + y * y + z * z;
}

inline Floats squaredDistanceToBox(const Floats& x, const Floats& y, const Floats& z, const float* half)
{
  const Floats beyond_x = atLeastZero(magnitude(x) - half[0]);
  const Floats beyond_y = atLeastZero(magnitude(y) - half[1]);
  const Floats beyond_z = atLeastZero(magnitude(z) - half[2]);
  return beyond_x * beyond_x + beyond_y * beyond_y + beyond_z * beyond_z;
}

/// Squared distance, in a plane, from a segment that begins at (x, y) and runs along (dx, dy).
inline Floats squaredDistanceToSegment(const Floats& x, const Floats& y, float dx, float dy)
{
  Floats share = (x * dx + y * dy) * (1.0F / (dx * dx + dy * dy));
  share = smaller(atLeastZero(share), all(1.0F));
  const Floats beside_x = x - share * dx;
  const Floats beside_y = y - share * dy;
  return beside_x * beside_x + beside_y * beside_y;
}

/// The squared distances of points from a solid cone; 0 inside. In the half plane through the axis and the point, the
/// cone is a triangle.
inline Floats squaredDistanceToCone(const Floats& from_axis, const Floats& z, float radius, float half)
{
  const Floats to_base = squaredDistanceToSegment(from_axis, z + half, radius, 0.0F);
  const Floats to_side = squaredDistanceToSegment(from_axis - radius, z + half, -radius, 2.0F * half);
  const Ints inside = (z >= -half) & (2.0F * half * (from_axis - radius) + radius * (z + half) <= 0.0F);
  return inside ? all(0.0F) : smaller(to_base, to_side);
}

/// The squared distances of points in the planning frame from an object; 0 inside.
inline Floats squaredDistanceTo(const Object& object, const Points& points)
{
  const float* pose = object.from_planning_frame;
  const Floats x = pose[0] * points.x + pose[1] * points.y + pose[2] * points.z + pose[3];
  if (object.kind == ObjectKind::HalfSpace)
  {
    const Floats above = atLeastZero(x);
    return above * above;
  }
  const Floats y = pose[4] * points.x + pose[5] * points.y + pose[6] * points.z + pose[7];
  const Floats z = pose[8] * points.x + pose[9] * points.y + pose[10] * points.z + pose[11];
  switch (object.kind)
  {
    case ObjectKind::Sphere:
    {
      const Floats beyond = atLeastZero(squareRoot(x * x + y * y + z * z) - object.half[0]);
      return beyond * beyond;
    }
    case ObjectKind::Cylinder:
    {
      const Floats beside = atLeastZero(squareRoot(x * x + y * y) - object.half[0]);
      const Floats beyond = atLeastZero(magnitude(z) - object.half[1]);
      return beside * beside + beyond * beyond;
    }
    case ObjectKind::Cone:
      return squaredDistanceToCone(squareRoot(x * x + y * y), z, object.half[0], object.half[1]);
    default:
      return squaredDistanceToBox(x, y, z, object.half);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core::lanes
