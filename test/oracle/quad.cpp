#include "oracle/quad.h"

#include <cmath>

namespace gpu_planning_scene::core::oracle
{
namespace
{
/// A truncated Taylor series: sin x = x - x^3/3! + ... (first = 1) or cos x = 1 - x^2/2! + ... (first = 0). For |x| <=
/// pi / 4 the first omitted term is below 1e-36.
Quad alternatingSeries(Quad x, int first)
{
  Quad term = first == 1 ? x : Quad(1);
  Quad sum = term;
  for (int n = first + 1; n < 32; n += 2)
  {
    term *= -(x * x) / (n * (n + 1));
    sum += term;
  }
  return sum;
}
}  // namespace

Quad sqrt(Quad value)
{
  if (!(value > 0))
    return 0;
  // Values near or below the range of double are scaled by a power of two, which is exact.
  if (value < Quad(1e-280))
    return sqrt(value * Quad(0x1p800)) * Quad(0x1p-400);
  // Two steps of Newton's method increase the 53 correct bits to more than 113.
  Quad root = std::sqrt(static_cast<double>(value));
  root = (root + value / root) / 2;
  return (root + value / root) / 2;
}

SineCosine sineCosine(Quad angle)
{
  // pi to 160 bits as a sum of doubles.
  const Quad half_pi =
      (Quad(3.14159265358979311600e+00) + Quad(1.22464679914735320717e-16) + Quad(-2.99476980971833966588e-33)) / 2;
  const double turns = std::nearbyint(static_cast<double>(angle / half_pi));
  const Quad rest = angle - turns * half_pi;
  const Quad sine = alternatingSeries(rest, 1);
  const Quad cosine = alternatingSeries(rest, 0);
  switch (static_cast<long long>(turns) & 3)
  {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

Motion::Motion(const Eigen::Isometry3d& pose) : translation(pose.translation())
{
  for (int i = 0; i < 3; ++i)
    rows[i] = Vector(pose.linear().row(i).transpose());
  // Newton's iteration for the orthogonal polar factor, R <- (3 R - R R^T R) / 2. Each step squares the error.
  for (int step = 0; step < 3; ++step)
  {
    const std::array<Vector, 3> r = rows;
    for (int i = 0; i < 3; ++i)
    {
      const Vector projected = dot(r[i], r[0]) * r[0] + dot(r[i], r[1]) * r[1] + dot(r[i], r[2]) * r[2];
      rows[i] = Quad(0.5) * (Quad(3) * r[i] - projected);
    }
  }
}

Motion Motion::operator*(const Motion& other) const
{
  Motion product;
  for (int i = 0; i < 3; ++i)
    product.rows[i] = other.unrotate(rows[i]);
  product.translation = *this * other.translation;
  return product;
}

Motion Motion::inverse() const
{
  Motion inverse;
  inverse.rows = {Vector(rows[0].x, rows[1].x, rows[2].x), Vector(rows[0].y, rows[1].y, rows[2].y),
                  Vector(rows[0].z, rows[1].z, rows[2].z)};
  inverse.translation = -unrotate(translation);
  return inverse;
}

Eigen::Isometry3d Motion::toDouble() const
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i)
    pose.linear().row(i) = rows[i].toDouble().transpose();
  pose.translation() = translation.toDouble();
  return pose;
}
}  // namespace gpu_planning_scene::core::oracle
