#include "model/description/position_limits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <urdf_model/model.h>

#include "base/text/name_list.h"
#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "model/description/velocity_limits.h"

// The limits of a joint are those that MoveIt's RobotModel and RobotModelLoader give it: the intersection of <limit>
// and <safety_controller>, and instead of each of these two numbers the number of joint_limits, if there is one.
namespace gpu_planning_scene::core
{
namespace
{
constexpr char kSafetyController[] = "the URDF's <safety_controller>";

std::string rangeText(double lower, double upper)
{
  return numberText(lower) + " to " + numberText(upper);
}

/// The joint and the number of the variable within it.
struct Owner
{
  const Joint* joint = nullptr;
  int part = 0;
};

/// The joint with this variable, or the joint of this name without a variable of its own.
Owner ownerOf(const RobotTree& tree, const std::string& name)
{
  for (const Joint& joint : tree.joints)
  {
    if (joint.name == name)
      return {&joint, 0};
    for (int i = 0; !joint.mimic && joint.type != JointType::Fixed && i < variableCount(joint.type); ++i)
      if (tree.variables[static_cast<std::size_t>(joint.first_variable) + static_cast<std::size_t>(i)].name == name)
        return {&joint, i};
  }
  return {};
}

/// Why limits of this joint have no effect, as in MoveIt; empty if they have an effect.
std::string whyWithoutLimits(const Joint& joint)
{
  if (joint.type == JointType::Fixed)
    return "is fixed";
  return joint.mimic ? "follows another joint, whose limits count" : "";
}

/// The same for position limits of a variable of the joint.
std::string whyWithoutPositionLimits(const Owner& owner)
{
  const Joint& joint = *owner.joint;
  if (std::string reason = whyWithoutLimits(joint); !reason.empty())
    return reason;
  if (joint.type == JointType::Continuous)
    return "is continuous; make it revolute in the URDF to limit it";
  if ((joint.type == JointType::Planar && owner.part == 2) || (joint.type == JointType::Floating && owner.part > 2))
    return "is a rotation of a planar or floating joint";
  return "";
}

/// A warning if a limit of a revolute joint may be in degrees, because it is a whole or half number of more than two
/// turns; else empty.
std::string mayBeInDegrees(const JointLimits& limits, const Joint& joint)
{
  constexpr double kTwoTurns = 4.0 * M_PI;
  for (const std::optional<double>& limit : {limits.min_position, limits.max_position})
    if (joint.type == JointType::Revolute && limit && std::abs(*limit) > kTwoTurns &&
        std::round(2.0 * *limit) == 2.0 * *limit)
      return limits.source + ": a position limit of '" + limits.variable + "' is " + numberText(*limit) +
             " rad, more than two turns; " + numberText(*limit) + " degrees are " + numberText(*limit * M_PI / 180.0) +
             " rad";
  return "";
}

/// Returns whether the limits are wider than before.
bool setLimits(const JointLimits& limits, Variable& variable)
{
  const std::string where = limits.source + ": '" + variable.name + "'";
  for (const std::optional<double>& limit : {limits.min_position, limits.max_position})
    if (limit && !std::isfinite(*limit))
      throw Error(where + " has a position limit that is not a finite number");
  if (!variable.bounded && !(limits.min_position && limits.max_position))
    throw Error(where + " has only one position limit, and the URDF has none; give min_position and max_position");
  const bool replaces_both = limits.min_position && limits.max_position;
  const double lower = limits.min_position.value_or(variable.lower);
  const double upper = limits.max_position.value_or(variable.upper);
  if (!(lower <= upper))
    throw Error(where + " has the position limits " + rangeText(lower, upper) + "; the first must not be above the " +
                "second" +
                (replaces_both
                     ? ""
                     : " (one of them is that of " +
                           (variable.limits_source.empty() ? "the URDF's <limit>" : variable.limits_source) + ")"));
  const bool are_wider = variable.bounded && (lower < variable.lower || upper > variable.upper);
  variable.bounded = true;
  variable.lower = lower;
  variable.upper = upper;
  variable.limits_source =
      (replaces_both || variable.limits_source.empty() ? "" : variable.limits_source + " and ") + limits.source;
  return are_wider;
}
}  // namespace

Variable limitedVariable(const urdf::Joint& joint, const std::string& where, std::vector<std::string>& warnings)
{
  // urdfdom refuses revolute and prismatic joints without limits.
  Variable variable;
  variable.name = joint.name;
  variable.bounded = true;
  variable.lower = joint.limits->lower;
  variable.upper = joint.limits->upper;
  variable.max_velocity = velocityLimit(joint);
  if (variable.lower > variable.upper)
    throw Error(where + " has a lower limit above its upper limit (" + std::to_string(variable.lower) + " > " +
                std::to_string(variable.upper) + ")");
  if (!joint.safety)
    return variable;
  const double lower = std::max(variable.lower, joint.safety->soft_lower_limit);
  const double upper = std::min(variable.upper, joint.safety->soft_upper_limit);
  if (!(lower <= upper))
    throw Error(where + ": no position is within its <limit>, " + rangeText(variable.lower, variable.upper) +
                ", and its <safety_controller>, " +
                rangeText(joint.safety->soft_lower_limit, joint.safety->soft_upper_limit) +
                " (a soft limit that is not given is 0)");
  if (lower == upper && variable.lower < variable.upper)
    warnings.push_back(where + " cannot move: its <safety_controller> leaves only the position " + numberText(lower) +
                       ", as in MoveIt (a soft limit that is not given is 0)");
  if (lower > variable.lower || upper < variable.upper)
    variable.limits_source = kSafetyController;
  variable.lower = lower;
  variable.upper = upper;
  return variable;
}

void applyJointLimits(const std::vector<JointLimits>& limits, RobotTree& tree, std::vector<std::string>& warnings)
{
  std::vector<std::string> unknown;
  std::vector<std::string> unknown_without_positions;
  for (const JointLimits& entry : limits)
  {
    const bool has_positions = entry.min_position || entry.max_position;
    const Owner owner = ownerOf(tree, entry.variable);
    if (owner.joint == nullptr)
    {
      (has_positions ? unknown : unknown_without_positions).push_back(entry.variable);
      continue;
    }
    if (variableCount(owner.joint->type) > 1 && owner.joint->name == entry.variable)
      throw Error(entry.source + ": joint '" + entry.variable + "' has several variables; name them as '" +
                  tree.variables[static_cast<std::size_t>(owner.joint->first_variable)].name + "' and so on");
    const int variable = owner.joint->first_variable + owner.part;
    const std::string prefix = entry.source + ": the " + (has_positions ? "position" : "velocity") + " limits of '" +
                               entry.variable + "' are not used, because it ";
    if (const std::string reason = has_positions ? whyWithoutPositionLimits(owner) : whyWithoutLimits(*owner.joint);
        !reason.empty())
      warnings.push_back(prefix + reason);
    else if (has_positions)
    {
      if (std::string degrees = mayBeInDegrees(entry, *owner.joint); !degrees.empty())
        warnings.push_back(std::move(degrees));
      if (setLimits(entry, tree.variables[static_cast<std::size_t>(variable)]))
        tree.widened.push_back(variable);
    }
    if (whyWithoutLimits(*owner.joint).empty())
      setVelocityLimits(entry, tree.variables[static_cast<std::size_t>(variable)]);
  }
  const auto warn = [&](const char* kind, const std::vector<std::string>& names)
  {
    if (!names.empty())
      warnings.push_back(limits.front().source + ": " + kind +
                         " limits are not used, because the robot does not have the joint: " + nameList(names));
  };
  warn("position", unknown);
  warn("velocity", unknown_without_positions);
}
}  // namespace gpu_planning_scene::core
