#include "gpu_planning_scene/kinematic_constraints.h"

#include <algorithm>
#include <cmath>

#include "base/math_constants.h"
#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "model/inverse_kinematics/constraint_values.h"
#include "model/rigid_pose.h"

namespace gpu_planning_scene::core
{
namespace
{
// Above the rounding of link poses. KinematicConstraints::pose turns an angle of 1e-9 rad into three smaller ones.
constexpr double kLeastLength = 1e-9;  // metres
constexpr double kLeastAngle = 5e-10;  // radians

constexpr int kTranslations = 3;  // the variables of a floating joint before those of its rotation

void requireTolerance(double value, double least, const std::string& what)
{
  if (!(std::isfinite(value) && value >= least))
    throw Error(what + " is " + numberText(value) + "; it must be at least " + numberText(least));
}

const std::string& linkName(const RobotModel& robot, int link, const std::string& where)
{
  if (link < 0 || static_cast<std::size_t>(link) >= robot.links().size())
    throw Error(where + " names link " + std::to_string(link) + ", which the robot does not have");
  return robot.links()[static_cast<std::size_t>(link)].name;
}

void validatePosition(const PositionConstraint& constraint, const RobotModel& robot, const std::string& where)
{
  const std::string of = where + ": the position of link '" + linkName(robot, constraint.link, where) + "'";
  if (!constraint.point.allFinite())
    throw Error(of + " has an offset that is not finite");
  nearestRigid(constraint.pose, of);
  if (const auto* sphere = std::get_if<Sphere>(&constraint.region))
    return requireTolerance(sphere->radius, kLeastLength, of + ": the radius");
  for (const double size : std::get<Box>(constraint.region).size)
    requireTolerance(size, kLeastLength, of + ": a size of the box");
}

void validateOrientation(const OrientationConstraint& constraint, const RobotModel& robot, const std::string& where)
{
  const std::string of = where + ": the orientation of link '" + linkName(robot, constraint.link, where) + "'";
  for (const Eigen::Matrix3d& rotation : {constraint.frame, constraint.wanted, constraint.axes})
  {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = rotation;
    nearestRigid(pose, of);
  }
  for (const double tolerance : constraint.tolerance)
    requireTolerance(tolerance, kLeastAngle, of + ": a tolerance");
}

void validateJoint(const JointConstraint& constraint, const RobotModel& robot, const std::string& where)
{
  if (constraint.variable < 0 || static_cast<std::size_t>(constraint.variable) >= robot.variables().size())
    throw Error(where + " names variable " + std::to_string(constraint.variable) + ", which the robot does not have");
  const Variable& variable = robot.variables()[static_cast<std::size_t>(constraint.variable)];
  const std::string of = where + ": the range of joint '" + variable.name + "', " + numberText(constraint.lower) +
                         " to " + numberText(constraint.upper) + ",";
  if (!(std::isfinite(constraint.lower) && std::isfinite(constraint.upper) && constraint.lower <= constraint.upper))
    throw Error(of + " is not a range");
  for (const Joint& joint : robot.joints())
    if (joint.type == JointType::Floating && constraint.variable >= joint.first_variable + kTranslations &&
        constraint.variable < joint.first_variable + variableCount(joint.type))
      throw Error(of + " is that of a quaternion's component; constrain the orientation of link '" +
                  robot.links()[static_cast<std::size_t>(joint.child_link)].name + "' instead");
  if (variable.bounded && (constraint.lower > variable.upper || constraint.upper < variable.lower))
    throw Error(of + " is outside the joint's limits, " + numberText(variable.lower) + " to " +
                numberText(variable.upper));
}

/// The distance of a value from its range; at most 0 within it. The ends of the range are compared without rounding,
/// because values are often exactly there: clampJoints moves them to an end.
double excessOf(const JointConstraint& constraint, double value)
{
  const double middle = 0.5 * (constraint.lower + constraint.upper);
  if (constraint.is_turn)
    value -= 2.0 * kPi * std::round((value - middle) / (2.0 * kPi));
  return std::max(constraint.lower - value, value - constraint.upper);
}
}  // namespace

KinematicConstraints KinematicConstraints::pose(int link, const Eigen::Isometry3d& frame, const Eigen::Isometry3d& pose,
                                                double position_tolerance, double orientation_tolerance)
{
  KinematicConstraints constraints;
  PositionConstraint position{link, frame.translation(), Eigen::Isometry3d::Identity(), Sphere{position_tolerance}};
  position.pose.translation() = pose.translation();
  constraints.positions.push_back(position);
  if (orientation_tolerance >= kPi)
    return constraints;
  // Three numbers of a rotation vector within the tolerance over the root of three: the angle is within the tolerance.
  constraints.orientations.push_back({link, frame.linear(), pose.linear(),
                                      Eigen::Vector3d::Constant(orientation_tolerance / std::sqrt(3.0)),
                                      OrientationConstraint::Parameterization::RotationVector});
  return constraints;
}

std::vector<int> KinematicConstraints::links() const
{
  std::vector<int> links;
  for (const PositionConstraint& constraint : positions)
    links.push_back(constraint.link);
  for (const OrientationConstraint& constraint : orientations)
    links.push_back(constraint.link);
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

void KinematicConstraints::append(const KinematicConstraints& other)
{
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  orientations.insert(orientations.end(), other.orientations.begin(), other.orientations.end());
  joints.insert(joints.end(), other.joints.begin(), other.joints.end());
}

void KinematicConstraints::addJoint(const RobotModel& robot, int variable, double lower, double upper)
{
  const bool is_turn = std::any_of(robot.joints().begin(), robot.joints().end(),
                                   [variable](const Joint& joint)
                                   {
                                     return (joint.type == JointType::Continuous && joint.first_variable == variable) ||
                                            (joint.type == JointType::Planar && joint.first_variable + 2 == variable);
                                   });
  // Ranges that differ by whole turns are equal.
  const double turns = is_turn ? 2.0 * kPi * std::round(0.25 * (lower + upper) / kPi) : 0.0;
  joints.push_back({variable, lower - turns, upper - turns, is_turn});
}

void KinematicConstraints::clampJoints(double* state) const
{
  for (const JointConstraint& range : joints)
  {
    double& value = state[range.variable];
    if (range.is_turn)
      value -= 2.0 * kPi * std::round((value - 0.5 * (range.lower + range.upper)) / (2.0 * kPi));
    value = std::clamp(value, range.lower, range.upper);
  }
}

void KinematicConstraints::validate(const RobotModel& robot, const std::string& where) const
{
  for (const PositionConstraint& constraint : positions)
    validatePosition(constraint, robot, where);
  for (const OrientationConstraint& constraint : orientations)
    validateOrientation(constraint, robot, where);
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    validateJoint(joints[i], robot, where);
    for (std::size_t k = 0; k < i; ++k)
      if (joints[k].variable == joints[i].variable &&
          std::max(joints[k].lower, joints[i].lower) > std::min(joints[k].upper, joints[i].upper))
        throw Error(where + ": two ranges of joint '" +
                    robot.variables()[static_cast<std::size_t>(joints[i].variable)].name + "' contradict each other");
  }
}

ConstraintViolation violationOf(const KinematicConstraints& constraints, const Eigen::Isometry3d* poses,
                                const double* state)
{
  ConstraintViolation violation;
  for (const PositionConstraint& constraint : constraints.positions)
  {
    const Eigen::Vector3d local = localPoint(constraint, poses[constraint.link]);
    violation.position = std::max(violation.position, (nearestInRegion(constraint, local, 1.0) - local).norm());
  }
  for (const OrientationConstraint& constraint : constraints.orientations)
  {
    const Eigen::Vector3d angles = orientationValues(constraint, poses[constraint.link]).angles;
    for (int axis = 0; axis < 3; ++axis)
      if (constraint.tolerance[axis] < kPi)
        violation.orientation = std::max(violation.orientation, std::abs(angles[axis]) - constraint.tolerance[axis]);
  }
  for (const JointConstraint& constraint : constraints.joints)
    violation.joint = std::max(violation.joint, excessOf(constraint, state[constraint.variable]));
  return violation;
}

std::string ConstraintViolation::text() const
{
  std::string text;
  const auto add = [&text](double value, const std::string& what)
  {
    if (value > 0.0)
      text += (text.empty() ? "" : " and ") + numberText(value) + what;
  };
  add(position, " m from the wanted position");
  add(orientation, " rad from the wanted orientation");
  add(joint, " from a wanted joint value");
  return text;
}
}  // namespace gpu_planning_scene::core
