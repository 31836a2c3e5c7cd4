#include "model/full_states.h"

#include <algorithm>

#include "base/text/name_list.h"
#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "model/virtual_joint.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string variableNames(const RobotModel& robot)
{
  std::vector<std::string> names;
  for (const Variable& variable : robot.variables())
    names.push_back(variable.name);
  return nameList(names);
}

/// The variables of the joints that the SRDF lists as passive, without the virtual joint and joints that mimic others.
std::vector<std::size_t> passiveVariables(const RobotModel& robot)
{
  std::vector<std::size_t> variables;
  for (const Joint& joint : robot.joints())
    for (int i = 0; joint.passive && !joint.mimic && joint.parent_link >= 0 && i < variableCount(joint.type); ++i)
      variables.push_back(static_cast<std::size_t>(joint.first_variable + i));
  return variables;
}

std::string whyNoVariable(const RobotModel& robot, const std::string& name)
{
  const int joint = robot.jointIndex(name);
  if (joint >= 0 && robot.joints()[joint].mimic)
    return "joint '" + name + "' mimics joint '" +
           robot.variables()[static_cast<std::size_t>(robot.joints()[joint].first_variable)].name +
           "', from which its value follows; leave it out";
  if (joint >= 0 && robot.joints()[joint].type == JointType::Fixed)
    return "joint '" + name + "' is fixed and has no variable; leave it out";
  return "the robot has no variable '" + name + "'";
}
}  // namespace

PartialState::PartialState(const RobotModel& robot)
  : values(robot.defaultState()), known(robot.variables().size(), false)
{
  for (const int variable : virtualVariables(robot))
    known[static_cast<std::size_t>(variable)] = true;
  for (const std::size_t variable : passiveVariables(robot))
    known[variable] = true;
}

PartialState::PartialState(const RobotModel& robot, const std::vector<double>& state) : PartialState(robot)
{
  if (state.empty())
    return;
  values = state;
  known.assign(values.size(), true);
}

std::string assumedPassiveJoints(const RobotModel& robot, const std::vector<bool>& given)
{
  const std::vector<double> values = robot.defaultState();
  std::vector<std::string> assumed;
  for (const std::size_t variable : passiveVariables(robot))
    if (!given[variable])
      assumed.push_back(robot.variables()[variable].name + " = " + numberText(values[variable]));
  return assumed.empty()
             ? ""
             : "no state has set passive joints of the SRDF; they have their default values: " + nameList(assumed);
}

std::vector<int> variableIndices(const RobotModel& robot, const std::vector<std::string>& names)
{
  std::vector<int> indices;
  std::vector<bool> seen(robot.variables().size(), false);
  for (const std::string& name : names)
  {
    const int index = robot.variableIndex(name);
    if (index < 0)
      throw Error(whyNoVariable(robot, name) + "; the robot's variables are " + variableNames(robot));
    if (seen[index])
      throw Error("variable '" + name + "' is given twice");
    seen[index] = true;
    indices.push_back(index);
  }
  return indices;
}

void requireVariableOfGroup(const RobotModel& robot, const std::string& group, const std::vector<int>& columns)
{
  if (group.empty())
    return;
  const std::vector<int>& variables = robot.group(group).variables;
  if (std::find_first_of(columns.begin(), columns.end(), variables.begin(), variables.end()) == columns.end())
    throw Error("the state sets no variable of the group '" + group + "'; for example, '" +
                robot.variables()[static_cast<std::size_t>(columns.front())].name +
                "' is not in it; give no group, or one that has this variable");
}

int movedVariableBeyond(const RobotModel& robot, const std::vector<int>& variables, const double* from,
                        const double* to)
{
  for (int i = 0; i < static_cast<int>(robot.variables().size()); ++i)
    if (from[i] != to[i] && std::find(variables.begin(), variables.end(), i) == variables.end())
      return i;
  return -1;
}

std::vector<double> fullStates(const RobotModel& robot, const std::vector<int>& columns, const double* rows,
                               std::size_t count, const PartialState& current)
{
  const std::size_t width = robot.variables().size();
  std::vector<bool> given(width, false);
  for (const int column : columns)
    given[column] = true;
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < width; ++i)
    if (!given[i] && !current.known[i])
      missing.push_back(robot.variables()[i].name);
  if (!missing.empty())
    throw NotKnownYet(
        "no value for " + nameList(missing) +
        "; give values for all joints (a named state takes no further values), or set the current state: with "
        "robot_state.joint_state in the scene file, or, for a node, with the topic joint_states or "
        "~apply_planning_scene; list joints that nobody measures, such as casters, as <passive_joint> in the SRDF");

  std::vector<double> states(count * width);
  for (std::size_t row = 0; row < count; ++row)
  {
    double* state = states.data() + row * width;
    std::copy(current.values.begin(), current.values.end(), state);
    for (std::size_t i = 0; i < columns.size(); ++i)
      state[columns[i]] = rows[row * columns.size() + i];
  }
  return states;
}
}  // namespace gpu_planning_scene::core
