#include "gpu_planning_scene/interpolation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "gpu_planning_scene/error.h"

// Interpolates joint by joint: lengths and bounded angles linearly, other angles along the shorter arc, rotations by
// spherical linear interpolation (Shoemake 1985).
namespace gpu_planning_scene::core
{
namespace
{
constexpr double kTurn = 2.0 * EIGEN_PI;

/// The kind of a group of joint variables. It decides how they are interpolated and how their travel is measured.
enum class ValueKind
{
  Length,
  Angle,         // linear, because the limits must not be crossed
  WrappedAngle,  // along the shorter arc of the circle
  Rotation       // a quaternion (x, y, z, w)
};

/// Calls visit(kind, first variable, number of variables) for each group of variables of an active joint.
template <class Visit>
void forVariableGroups(const RobotModel& robot, const Joint& joint, const Visit& visit)
{
  const int first = joint.first_variable;
  switch (joint.type)
  {
    case JointType::Revolute:
      visit(ValueKind::Angle, first, 1);
      break;
    case JointType::Continuous:
      visit(isPeriodic(robot, joint) ? ValueKind::WrappedAngle : ValueKind::Angle, first, 1);
      break;
    case JointType::Prismatic:
      visit(ValueKind::Length, first, 1);
      break;
    case JointType::Planar:
      visit(ValueKind::Length, first, 2);
      visit(ValueKind::WrappedAngle, first + 2, 1);
      break;
    case JointType::Floating:
      visit(ValueKind::Length, first, 3);
      visit(ValueKind::Rotation, first + 3, 4);
      break;
    case JointType::Fixed:
      break;
  }
}

/// The same for all active joints of the robot.
template <class Visit>
void forVariableGroups(const RobotModel& robot, const Visit& visit)
{
  for (const Joint& joint : robot.joints())
    if (!joint.mimic && joint.first_variable >= 0)
      forVariableGroups(robot, joint, visit);
}

/// The rotation of a state's quaternion, as forward kinematics reads it: the quaternion may have any length above 0,
/// and the quaternion 0 means no rotation.
Eigen::Quaterniond rotationOf(const double* variables)
{
  Eigen::Vector4d coefficients = Eigen::Map<const Eigen::Vector4d>(variables);
  const double largest = coefficients.cwiseAbs().maxCoeff();
  if (largest == 0.0)
    return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::Vector4d(coefficients / largest)).normalized();
}

/// The travel of a group of variables, in radians or metres: the largest change of its variables, or half of the
/// angle of a rotation.
double travelOf(ValueKind kind, const double* from, const double* to, int count)
{
  // Most motions leave some joints at rest, and remainders and rotations take time.
  if (std::equal(from, from + count, to))
    return 0.0;
  switch (kind)
  {
    case ValueKind::WrappedAngle:
      return std::abs(shortestAngularDistance(*from, *to));
    case ValueKind::Rotation:
      return 0.5 * rotationOf(from).angularDistance(rotationOf(to));
    default:
      return (Eigen::Map<const Eigen::VectorXd>(to, count) - Eigen::Map<const Eigen::VectorXd>(from, count))
          .cwiseAbs()
          .maxCoeff();
  }
}

void refuseStep(double step, const char* name, const char* unit)
{
  if (!std::isfinite(step) || step <= 0.0)
    throw Error(std::string("the ") + name + " step of motions is " + std::to_string(step) +
                "; it must be a finite number of " + unit + " above 0");
}

}  // namespace

double shortestAngularDistance(double from, double to)
{
  return std::remainder(std::remainder(to, kTurn) - std::remainder(from, kTurn), kTurn);
}

bool isPeriodic(const RobotModel& robot, const Joint& joint)
{
  return std::none_of(
      robot.joints().begin(), robot.joints().end(),
      [&joint](const Joint& other)
      {
        return other.mimic && other.first_variable == joint.first_variable &&
               (other.type == JointType::Prismatic || other.multiplier != std::round(other.multiplier));
      });
}

void validateSteps(const MotionSteps& steps)
{
  refuseStep(steps.revolute, "revolute", "radians");
  refuseStep(steps.prismatic, "prismatic", "metres");
}

/// A mimic joint uses the variable of the joint that it mimics; its travel is a multiple of that joint's travel.
std::vector<JointTravel> jointTravel(const RobotModel& robot, const double* from, const double* to)
{
  std::vector<JointTravel> travel(robot.joints().size());
  const auto follow = [&](const Joint& leader, double amount)
  {
    for (std::size_t i = 0; i < travel.size(); ++i)
      if (const Joint& joint = robot.joints()[i]; joint.mimic && joint.first_variable == leader.first_variable)
        (joint.type == JointType::Prismatic ? travel[i].length : travel[i].angle) = std::abs(joint.multiplier) * amount;
  };
  for (std::size_t i = 0; i < travel.size(); ++i)
  {
    const Joint& joint = robot.joints()[i];
    if (joint.mimic || joint.first_variable < 0)
      continue;
    forVariableGroups(robot, joint,
                      [&](ValueKind kind, int first, int count)
                      {
                        const double* const start = from + first;
                        const double* const end = to + first;
                        if (kind == ValueKind::Rotation)
                          travel[i].angle = rotationOf(start).angularDistance(rotationOf(end));
                        else if (kind == ValueKind::Length)
                          travel[i].length = (Eigen::Map<const Eigen::VectorXd>(end, count) -
                                              Eigen::Map<const Eigen::VectorXd>(start, count))
                                                 .norm();
                        else
                          travel[i].angle = travelOf(kind, start, end, count);
                      });
    follow(joint, joint.type == JointType::Prismatic ? travel[i].length : travel[i].angle);
  }
  return travel;
}

double segmentCount(const RobotModel& robot, const double* from, const double* to, const MotionSteps& steps)
{
  double most = 1.0;
  forVariableGroups(robot,
                    [&](ValueKind kind, int first, int count)
                    {
                      const double step = kind == ValueKind::Length ? steps.prismatic : steps.revolute;
                      most = std::max(most, std::ceil(travelOf(kind, from + first, to + first, count) / step));
                    });
  return most;
}

void interpolate(const RobotModel& robot, const double* from, const double* to, double fraction, double* state)
{
  if (fraction == 0.0 || fraction == 1.0)
  {
    std::copy_n(fraction == 0.0 ? from : to, robot.variables().size(), state);
    return;
  }
  forVariableGroups(robot,
                    [&](ValueKind kind, int first, int count)
                    {
                      if (kind == ValueKind::Rotation)
                      {
                        Eigen::Map<Eigen::Vector4d>(state + first) =
                            rotationOf(from + first).slerp(fraction, rotationOf(to + first)).coeffs();
                        return;
                      }
                      for (int i = first; i < first + count; ++i)
                        // A value that does not move stays the same, bit by bit.
                        state[i] = from[i] == to[i] ? from[i]
                                   : kind == ValueKind::WrappedAngle
                                       ? from[i] + fraction * shortestAngularDistance(from[i], to[i])
                                       : (1.0 - fraction) * from[i] + fraction * to[i];
                    });
}
}  // namespace gpu_planning_scene::core
