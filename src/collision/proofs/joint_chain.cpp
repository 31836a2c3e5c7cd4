#include "collision/proofs/joint_chain.h"

#include <algorithm>
#include <cmath>

#include "base/math_constants.h"

// The paths from both links to the root, without their common end. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr int kCellsOfOne = 1024;
constexpr int kCellsOfTwo = 256;

/// The joints from a link to the root.
std::vector<int> jointsAbove(const RobotModel& robot, int link)
{
  std::vector<int> joints;
  while (link >= 0 && robot.links()[static_cast<std::size_t>(link)].parent_joint >= 0)
  {
    joints.push_back(robot.links()[static_cast<std::size_t>(link)].parent_joint);
    link = robot.joints()[static_cast<std::size_t>(joints.back())].parent_link;
  }
  return joints;
}

/// The range of a variable that moves joints of the chain, as a single cell; no value: the variable has no usable
/// range.
std::optional<TableVariable> rangeOf(const RobotModel& robot, int number, const std::vector<ChainJoint>& chain)
{
  const Variable& variable = robot.variables()[static_cast<std::size_t>(number)];
  const auto is_turning = [number](const ChainJoint& part)
  {
    return part.joint->first_variable != number ||
           (part.joint->type != JointType::Prismatic && std::abs(part.joint->multiplier) == 1.0);
  };
  const bool wraps = std::all_of(chain.begin(), chain.end(), is_turning) &&
                     (!variable.bounded || variable.upper - variable.lower >= 2.0 * kPi);
  if (!wraps && !variable.bounded)
    return std::nullopt;
  const double slack = wraps ? 0.0 : 1e-6 * (variable.upper - variable.lower) + 1e-9;
  const double lower = wraps ? -kPi : variable.lower - slack;
  const double upper = wraps ? kPi : variable.upper + slack;
  return TableVariable{number, wraps, lower, upper - lower, 1};
}
}  // namespace

std::vector<ChainJoint> jointsBetween(const RobotModel& robot, int from, int to)
{
  std::vector<int> above_from = jointsAbove(robot, from);
  std::vector<int> above_to = jointsAbove(robot, to);
  while (!above_from.empty() && !above_to.empty() && above_from.back() == above_to.back())
  {
    above_from.pop_back();
    above_to.pop_back();
  }
  std::vector<ChainJoint> chain;
  for (const int joint : above_from)
    chain.push_back({&robot.joints()[static_cast<std::size_t>(joint)], true});
  for (auto joint = above_to.rbegin(); joint != above_to.rend(); ++joint)
    chain.push_back({&robot.joints()[static_cast<std::size_t>(*joint)], false});
  return chain;
}

std::optional<std::vector<TableVariable>> chainVariables(const RobotModel& robot, const std::vector<ChainJoint>& chain)
{
  std::vector<TableVariable> variables;
  for (const ChainJoint& part : chain)
  {
    const Joint& joint = *part.joint;
    if (joint.type == JointType::Fixed)
      continue;
    if (joint.type == JointType::Planar || joint.type == JointType::Floating)
      return std::nullopt;
    const auto is_known = [&joint](const TableVariable& known) { return known.variable == joint.first_variable; };
    if (std::any_of(variables.begin(), variables.end(), is_known))
      continue;
    const std::optional<TableVariable> range = rangeOf(robot, joint.first_variable, chain);
    if (!range)
      return std::nullopt;
    variables.push_back(*range);
  }
  return variables;
}

std::optional<std::vector<TableVariable>> tableVariables(const RobotModel& robot, const std::vector<ChainJoint>& chain)
{
  std::optional<std::vector<TableVariable>> variables = chainVariables(robot, chain);
  if (!variables || variables->empty() || variables->size() > 2)
    return std::nullopt;
  for (TableVariable& variable : *variables)
  {
    variable.cells = variables->size() == 1 ? kCellsOfOne : kCellsOfTwo;
    variable.cell_width /= variable.cells;
  }
  return variables;
}
}  // namespace gpu_planning_scene::core
