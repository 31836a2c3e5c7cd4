#include "model/inverse_kinematics/constraint_values.h"

#include <algorithm>
#include <cmath>

#include "base/math_constants.h"

// The derivatives of the parameters of a rotation: J. Diebel: Representing attitude: Euler angles, unit quaternions,
// and rotation vectors. Stanford University, 2006. F. Bullo, R. M. Murray: Proportional derivative (PD) control on the
// Euclidean group. European Control Conference, 1995 (rotation vectors).
namespace gpu_planning_scene::core
{
namespace
{
// Below this cosine of the second Euler angle, the first and the third one turn about the same axis.
constexpr double kSingular = 1e-9;

// Keeps the derivatives finite near the singularity. There they only guide a descent.
constexpr double kLeastCosine = 1e-3;

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v)
{
  return (Eigen::Matrix3d() << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0).finished();
}

/// Angles of rotation = Rx(a) Ry(b) Rz(c), with b from -pi/2 to pi/2. If b is at the end of its range, only a sum of
/// the other two is known. Then a is as large as its tolerance allows, and c is the rest.
Eigen::Vector3d eulerAngles(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& tolerance)
{
  const double cosine = std::hypot(rotation(0, 0), rotation(0, 1));
  const double b = std::atan2(rotation(0, 2), cosine);
  if (cosine > kSingular)
    return {std::atan2(-rotation(1, 2), rotation(2, 2)), b, std::atan2(-rotation(0, 1), rotation(0, 0))};
  const double sum = std::atan2(rotation(2, 1), rotation(1, 1));  // a + c if b is positive, else a - c
  const double a = std::clamp(sum, -tolerance.x(), tolerance.x());
  return {a, b, b > 0.0 ? sum - a : a - sum};
}

Eigen::Matrix3d eulerRates(const Eigen::Vector3d& angles)
{
  const double sine = std::sin(angles.x());
  const double cosine = std::cos(angles.x());
  const double sine_b = std::sin(angles.y());
  const double cosine_b = std::max(std::cos(angles.y()), kLeastCosine);
  // The inverse of the matrix with the axes of the three rotations as columns.
  Eigen::Matrix3d rates;
  rates << 1.0, sine * sine_b / cosine_b, -cosine * sine_b / cosine_b,  //
      0.0, cosine, sine,                                                //
      0.0, -sine / cosine_b, cosine / cosine_b;
  return rates;
}

Eigen::Matrix3d rotationVectorRates(const Eigen::Vector3d& vector)
{
  constexpr double kSmall = 1e-4;
  const double angle = vector.norm();
  const double factor = angle < kSmall ? 1.0 / 12.0 : (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
  const Eigen::Matrix3d cross = crossMatrix(vector);
  return Eigen::Matrix3d::Identity() - 0.5 * cross + factor * cross * cross;
}
}  // namespace

Eigen::Vector3d localPoint(const PositionConstraint& constraint, const Eigen::Isometry3d& link)
{
  return constraint.pose.linear().transpose() * (link * constraint.point - constraint.pose.translation());
}

Eigen::Vector3d nearestInRegion(const PositionConstraint& constraint, const Eigen::Vector3d& local, double share)
{
  if (const auto* sphere = std::get_if<Sphere>(&constraint.region))
  {
    const double distance = local.norm();
    const double radius = share * sphere->radius;
    return distance <= radius ? local : Eigen::Vector3d(local * (radius / distance));
  }
  const Eigen::Vector3d half = 0.5 * share * std::get<Box>(constraint.region).size;
  return local.cwiseMax(-half).cwiseMin(half);
}

OrientationValues orientationValues(const OrientationConstraint& constraint, const Eigen::Isometry3d& link)
{
  const Eigen::Matrix3d to_wanted = constraint.wanted.transpose();
  const Eigen::Matrix3d rotation = to_wanted * link.linear() * constraint.frame;
  if (constraint.parameterization == OrientationConstraint::Parameterization::XyzEulerAngles)
  {
    const Eigen::Vector3d angles = eulerAngles(rotation, constraint.tolerance);
    return {angles, eulerRates(angles) * to_wanted};
  }
  const Eigen::AngleAxisd turn(rotation);
  const Eigen::Vector3d vector = turn.angle() * turn.axis();
  const Eigen::Matrix3d to_axes = constraint.axes.transpose() * constraint.wanted;
  return {to_axes * vector, to_axes * rotationVectorRates(vector) * to_wanted};
}
}  // namespace gpu_planning_scene::core
