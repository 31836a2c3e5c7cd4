#include "moveit/planner/joint_goals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/math_constants.h"
#include "gpu_planning_scene/interpolation.h"
#include "moveit/planner/refusal.h"

// A set of joint constraints is a box in joint space. Its middle is the goal, and random states of the box are further
// goals if the box is wide or if its middle collides.
namespace gpu_planning_scene::pipeline
{
namespace
{
using core::JointType;
using core::kPi;

constexpr double kTextRounding = 1e-9;  // radians or metres: of positions and limits that were written as text
constexpr double kWide = 0.02;          // radians or metres

enum class ValueKind
{
  Limited,
  Angle,    ///< without limits, whole turns do not matter
  Rotation  ///< a component of a quaternion
};

ValueKind kindOf(const core::RobotModel& robot, int variable)
{
  for (const core::Joint& joint : robot.joints())
  {
    if (joint.mimic || joint.first_variable < 0)
      continue;
    const int number = variable - joint.first_variable;
    if (number < 0 || number >= core::variableCount(joint.type))
      continue;
    if (joint.type == JointType::Continuous || (joint.type == JointType::Planar && number == 2))
      return ValueKind::Angle;
    return joint.type == JointType::Floating && number >= 3 ? ValueKind::Rotation : ValueKind::Limited;
  }
  return ValueKind::Limited;
}

/// The values that constraints allow for a variable.
struct Wanted
{
  double position;
  double lower;
  double upper;

  /// Whether a value fulfils the constraints. As in MoveIt, an angle counts at its shortest distance from the position.
  bool contains(double value, ValueKind kind) const
  {
    if (kind == ValueKind::Angle)
      value = position + core::shortestAngularDistance(position, value);
    return value >= lower - kTextRounding && value <= upper + kTextRounding;
  }
};

[[noreturn]] void refuse(const std::string& joint, const std::string& fault,
                         int code = MoveItErrorCodes::INVALID_GOAL_CONSTRAINTS)
{
  throw Refusal(code, "the constraint of joint '" + joint + "' " + fault);
}

void validate(const moveit_msgs::JointConstraint& constraint)
{
  if (!std::isfinite(constraint.position))
    refuse(constraint.joint_name, "has a position that is not finite");
  if (!(constraint.tolerance_above >= 0.0 && constraint.tolerance_below >= 0.0))
    refuse(constraint.joint_name, "has a tolerance below 0; tolerances are distances in both directions");
}

/// The constraints by the index of the converted variable.
std::map<int, Wanted> wantedValues(const moveit_msgs::Constraints& constraints, const moveit::core::RobotModel& model,
                                   const RobotConversion& robot)
{
  std::map<int, Wanted> wanted;
  const std::vector<std::string>& names = model.getVariableNames();
  for (const moveit_msgs::JointConstraint& constraint : constraints.joint_constraints)
  {
    validate(constraint);
    const auto name = std::find(names.begin(), names.end(), constraint.joint_name);
    if (name == names.end())
      refuse(constraint.joint_name,
             "names no variable of the robot; a joint with several variables needs JOINT/x, for "
             "example");
    const auto& variable = robot.variable(static_cast<std::size_t>(name - names.begin()));
    if (variable.multiplier == 0.0)
      refuse(constraint.joint_name, "names a joint that cannot move; leave it out");
    Wanted value{(constraint.position - variable.offset) / variable.multiplier,
                 (constraint.position - constraint.tolerance_below - variable.offset) / variable.multiplier,
                 (constraint.position + constraint.tolerance_above - variable.offset) / variable.multiplier};
    if (value.lower > value.upper)
      std::swap(value.lower, value.upper);
    const auto [known, is_new] = wanted.emplace(variable.index, value);
    if (is_new)
      continue;
    if (kindOf(*robot.robot(), variable.index) != ValueKind::Limited)
      refuse(constraint.joint_name, "is given twice; give it once");
    known->second.lower = std::max(known->second.lower, value.lower);
    known->second.upper = std::min(known->second.upper, value.upper);
    if (known->second.lower > known->second.upper + kTextRounding)
      refuse(constraint.joint_name, "contradicts another constraint of the same joint");
  }
  return wanted;
}

/// Normalises the rotations of floating joints. Throws Refusal if a rotation is constrained in part, or if the
/// tolerances do not contain the normalised one.
void setRotations(const core::RobotModel& robot, const std::map<int, Wanted>& wanted, std::vector<double>& row)
{
  constexpr int kFirst = 3;
  for (const core::Joint& joint : robot.joints())
  {
    if (joint.type != JointType::Floating || joint.mimic)
      continue;
    const int first = joint.first_variable + kFirst;
    const auto given =
        std::count_if(wanted.begin(), wanted.end(),
                      [first](const auto& entry) { return entry.first >= first && entry.first < first + 4; });
    if (given == 0)
      continue;
    if (given != 4)
      refuse(joint.name, "has a part of a rotation; give all of rot_x, rot_y, rot_z, rot_w");
    Eigen::Map<Eigen::Vector4d> rotation(&row[static_cast<std::size_t>(first)]);
    if (rotation.norm() == 0.0)
      refuse(joint.name, "has a rotation of length 0");
    rotation.normalize();
    for (int i = first; i < first + 4; ++i)
      if (!wanted.at(i).contains(row[static_cast<std::size_t>(i)], ValueKind::Rotation))
        refuse(joint.name, "has a rotation that is not of length 1");
  }
}
}  // namespace

GoalRegion::GoalRegion(const moveit_msgs::Constraints& constraints, const moveit::core::RobotModel& model,
                       const RobotConversion& robot, const core::GroupStateSpace& space,
                       const std::vector<double>& start)
  : middle_(start)
{
  const core::RobotModel& converted = *robot.robot();
  const std::map<int, Wanted> wanted = wantedValues(constraints, model, robot);
  for (const auto& [index, value] : wanted)
  {
    const core::Variable& variable = converted.variables()[static_cast<std::size_t>(index)];
    const ValueKind kind = kindOf(converted, index);
    if (std::find(space.variables().begin(), space.variables().end(), index) != space.variables().end())
      middle_[static_cast<std::size_t>(index)] = value.position;
    else if (!value.contains(start[static_cast<std::size_t>(index)], kind))
      refuse(variable.name, "cannot be fulfilled: group '" + space.group().name + "' does not move it, and it is " +
                                std::to_string(start[static_cast<std::size_t>(index)]) + " in the start");
  }
  setRotations(converted, wanted, middle_);
  for (const int index : space.variables())
  {
    const core::Variable& variable = converted.variables()[static_cast<std::size_t>(index)];
    const ValueKind kind = kindOf(converted, index);
    Range range{index, variable.lower, variable.upper, kind != ValueKind::Rotation};
    const auto value = wanted.find(index);
    if (value != wanted.end() && kind == ValueKind::Angle)
    {
      const double below = std::min(value->second.position - value->second.lower, kPi);
      const double above = std::min(value->second.upper - value->second.position, kPi);
      range.lower = value->second.position - below;
      range.upper = value->second.position + above;
    }
    else if (value != wanted.end() && kind == ValueKind::Limited)
    {
      range.lower = std::max(range.lower, value->second.lower);
      range.upper = std::min(range.upper, value->second.upper);
      if (range.lower > range.upper + kTextRounding)
        refuse(variable.name,
               "asks for " + std::to_string(value->second.lower) + " to " + std::to_string(value->second.upper) +
                   ", outside the limits " + std::to_string(variable.lower) + " to " + std::to_string(variable.upper),
               MoveItErrorCodes::GOAL_STATE_INVALID);
      // Limits and constraints that contradict each other by a rounding error: the limits are kept.
      range.lower = std::min(range.lower, variable.upper);
      range.upper = std::max(range.upper, range.lower);
      double& middle = middle_[static_cast<std::size_t>(index)];
      middle = std::clamp(middle, range.lower, range.upper);
    }
    ranges_.push_back(range);
  }
}

bool GoalRegion::isWide() const
{
  return std::any_of(
      ranges_.begin(), ranges_.end(),
      [](const Range& range) { return range.sampled && range.upper - range.lower > kWide; });
}

std::vector<double> GoalRegion::sample(std::mt19937_64& random) const
{
  std::vector<double> row = middle_;
  for (const Range& range : ranges_)
    if (range.sampled)
      row[static_cast<std::size_t>(range.variable)] = std::clamp(
          std::uniform_real_distribution<double>(range.lower, range.upper)(random), range.lower, range.upper);
  return row;
}

void addJointRanges(const moveit_msgs::Constraints& constraints, const moveit::core::RobotModel& model,
                    const RobotConversion& robot, core::KinematicConstraints& ranges)
{
  for (const auto& [index, value] : wantedValues(constraints, model, robot))
    ranges.addJoint(*robot.robot(), index, value.lower, value.upper);
}

bool isJointGoal(const moveit_msgs::Constraints& constraints)
{
  return !constraints.joint_constraints.empty() && constraints.position_constraints.empty() &&
         constraints.orientation_constraints.empty() && constraints.visibility_constraints.empty();
}
}  // namespace gpu_planning_scene::pipeline
