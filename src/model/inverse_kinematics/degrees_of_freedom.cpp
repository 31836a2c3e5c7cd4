#include "model/inverse_kinematics/degrees_of_freedom.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/math_constants.h"

namespace gpu_planning_scene::core
{
DegreesOfFreedom narrowed(DegreesOfFreedom freedoms, const std::vector<JointConstraint>& ranges)
{
  for (DegreeOfFreedom& freedom : freedoms)
    for (const JointConstraint& range : ranges)
    {
      if (range.variable != freedom.variable || freedom.axis >= 0)
        continue;
      freedom.lower = freedom.bounded ? std::max(freedom.lower, range.lower) : range.lower;
      freedom.upper = freedom.bounded ? std::min(freedom.upper, range.upper) : range.upper;
      freedom.bounded = true;
    }
  return freedoms;
}

void advance(const DegreesOfFreedom& freedoms, const Eigen::VectorXd& step, double* state)
{
  for (std::size_t i = 0; i < freedoms.size(); ++i)
  {
    const DegreeOfFreedom& freedom = freedoms[i];
    const double by = step[static_cast<Eigen::Index>(i)];
    double* value = state + freedom.variable;
    if (freedom.axis < 0)
    {
      *value += by;
      if (freedom.bounded)
        *value = std::clamp(*value, freedom.lower, freedom.upper);
      continue;
    }
    Eigen::Map<Eigen::Quaterniond> rotation(value);  // x, y, z, w
    if (rotation.coeffs().isZero(0.0))
      rotation.setIdentity();  // as RobotModel::linkPoses takes it
    rotation = (rotation * Eigen::Quaterniond(Eigen::AngleAxisd(by, Eigen::Vector3d::Unit(freedom.axis)))).normalized();
  }
}

void clampToLimits(const DegreesOfFreedom& freedoms, double* state)
{
  constexpr double kTurn = 2.0 * kPi;
  for (const DegreeOfFreedom& freedom : freedoms)
  {
    double& value = state[freedom.variable];
    if (!freedom.bounded || (value >= freedom.lower && value <= freedom.upper))
      continue;
    if (freedom.is_turn)
      value -= kTurn * std::round((value - 0.5 * (freedom.lower + freedom.upper)) / kTurn);
    value = std::clamp(value, freedom.lower, freedom.upper);
  }
}

void turnTowards(const DegreesOfFreedom& freedoms, const double* wanted, double* state)
{
  constexpr double kTurn = 2.0 * kPi;
  for (const DegreeOfFreedom& freedom : freedoms)
  {
    if (freedom.axis == 0)
    {
      Eigen::Map<Eigen::Vector4d> quaternion(state + freedom.variable);
      if (quaternion.dot(Eigen::Map<const Eigen::Vector4d>(wanted + freedom.variable)) < 0.0)
        quaternion = -quaternion;
    }
    if (!freedom.is_turn)
      continue;
    double& angle = state[freedom.variable];
    double turns = std::round((wanted[freedom.variable] - angle) / kTurn);
    if (freedom.bounded)
    {
      const double fewest = std::ceil((freedom.lower - angle) / kTurn);
      const double most = std::floor((freedom.upper - angle) / kTurn);
      turns = fewest > most ? 0.0 : std::clamp(turns, fewest, most);
    }
    angle += turns * kTurn;
    if (freedom.bounded)
      angle = std::clamp(angle, freedom.lower, freedom.upper);
  }
}
}  // namespace gpu_planning_scene::core
