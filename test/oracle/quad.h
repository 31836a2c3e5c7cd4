#pragma once

#include <array>
#include <cfloat>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core::oracle
{
/// Quadruple precision, 113 bits. The product of two doubles is exact, and so is the sum of doubles of similar size.
#if defined(__x86_64__)
__extension__ typedef __float128 Quad;
#else
typedef long double Quad;  // on ARM, which has no __float128
static_assert(LDBL_MANT_DIG == 113, "long double has not quadruple precision here");
#endif

Quad sqrt(Quad value);

struct SineCosine
{
  Quad sine;
  Quad cosine;
};
/// The error is about 1e-33 for angles of up to 1e6.
SineCosine sineCosine(Quad angle);

inline Quad abs(Quad value)
{
  return value < 0 ? -value : value;
}

struct Vector
{
  Quad x = 0;
  Quad y = 0;
  Quad z = 0;

  Vector() = default;
  Vector(Quad x_value, Quad y_value, Quad z_value) : x(x_value), y(y_value), z(z_value) {}
  explicit Vector(const Eigen::Vector3d& v) : x(v.x()), y(v.y()), z(v.z()) {}

  Eigen::Vector3d toDouble() const { return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}; }
};

inline Vector operator+(const Vector& a, const Vector& b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector& a, const Vector& b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator-(const Vector& a)
{
  return {-a.x, -a.y, -a.z};
}
inline Vector operator*(Quad factor, const Vector& a)
{
  return {factor * a.x, factor * a.y, factor * a.z};
}
inline Quad dot(const Vector& a, const Vector& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector cross(const Vector& a, const Vector& b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Quad squaredLength(const Vector& a)
{
  return dot(a, a);
}
inline Quad length(const Vector& a)
{
  return sqrt(squaredLength(a));
}

/// A rigid motion: a rotation, then a translation.
struct Motion
{
  std::array<Vector, 3> rows = {Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1)};  // rows of the rotation
  Vector translation;

  Motion() = default;
  /// Uses the rotation that is nearest to the pose's matrix, which is a rotation only up to the rounding of double.
  explicit Motion(const Eigen::Isometry3d& pose);

  Vector rotate(const Vector& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  Vector unrotate(const Vector& v) const { return v.x * rows[0] + v.y * rows[1] + v.z * rows[2]; }
  Vector operator*(const Vector& point) const { return rotate(point) + translation; }
  Motion operator*(const Motion& other) const;
  Motion inverse() const;

  Eigen::Isometry3d toDouble() const;
};
}  // namespace gpu_planning_scene::core::oracle
