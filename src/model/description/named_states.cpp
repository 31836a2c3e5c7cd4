#include "model/description/named_states.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The finite numbers of a text like "0 1.5 -2"; empty if there is anything else in it.
std::vector<double> numbersOf(const std::string& text)
{
  std::vector<double> numbers;
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  for (std::string word; words >> word;)
  {
    std::istringstream digits(word);
    digits.imbue(std::locale::classic());
    double number = 0.0;
    if (!(digits >> number) || !digits.eof() || !std::isfinite(number))
      return {};
    numbers.push_back(number);
  }
  return numbers;
}

bool hasGroup(const RobotModel& robot, const std::string& name)
{
  return std::any_of(
      robot.groups().begin(), robot.groups().end(), [&](const Group& group) { return group.name == name; });
}

NamedState resolved(const SrdfNamedState& state, const RobotModel& robot, const std::set<std::string>& ignored_joints,
                    std::vector<std::string>& warnings)
{
  NamedState result{state.name, state.group, {}, {}};
  const std::vector<int>& group_joints = robot.group(state.group).joints;
  for (const auto& [joint_name, text] : state.values)
  {
    const int index = robot.jointIndex(joint_name.name);
    if (index < 0 && ignored_joints.count(joint_name.name) != 0)
      continue;
    const std::string start = joint_name.where + ": state '" + state.name + "': joint '" + joint_name.name + "' ";
    if (index < 0)
    {
      warnings.push_back(start + "is not in the robot, the entry is ignored");
      continue;
    }
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    if (joint.type == JointType::Fixed || joint.mimic)
      continue;
    if (std::find(group_joints.begin(), group_joints.end(), index) == group_joints.end())
    {
      warnings.push_back(start + "is not in its group '" + state.group + "', the entry is ignored, as in MoveIt");
      continue;
    }
    const std::vector<double> values = numbersOf(text);
    if (static_cast<int>(values.size()) != variableCount(joint.type))
    {
      warnings.push_back(start + "needs " + std::to_string(variableCount(joint.type)) + " finite numbers, not '" +
                         text + "'; the entry is ignored");
      continue;
    }
    for (std::size_t i = 0; i < values.size(); ++i)
      result.variables.push_back(joint.first_variable + static_cast<int>(i));
    result.values.insert(result.values.end(), values.begin(), values.end());
  }
  return result;
}

/// Adds the values of `from` to `to`. Throws Error if they disagree.
void merge(const NamedState& from, const RobotModel& robot, NamedState& to)
{
  for (std::size_t i = 0; i < from.variables.size(); ++i)
  {
    const auto found = std::find(to.variables.begin(), to.variables.end(), from.variables[i]);
    if (found == to.variables.end())
    {
      to.variables.push_back(from.variables[i]);
      to.values.push_back(from.values[i]);
    }
    else if (to.values[static_cast<std::size_t>(found - to.variables.begin())] != from.values[i])
    {
      if (from.group == to.group)
        throw Error("the SRDF has the state '" + from.group + "/" + from.name +
                    "' more than once, with different values; remove all but one");
      throw Error("the states '" + from.name + "' of the SRDF give " +
                  robot.variables()[static_cast<std::size_t>(from.variables[i])].name +
                  " different values; write GROUP/NAME: " + to.group + "/" + to.name + " or " + from.group + "/" +
                  from.name);
    }
  }
}
}  // namespace

std::vector<NamedState> resolveNamedStates(const std::vector<SrdfNamedState>& states, const RobotModel& robot,
                                           const std::set<std::string>& ignored_joints,
                                           std::vector<std::string>& warnings)
{
  std::vector<NamedState> result;
  for (const SrdfNamedState& state : states)
    if (hasGroup(robot, state.group))
      result.push_back(resolved(state, robot, ignored_joints, warnings));
    else
      warnings.push_back(state.where + ": state '" + state.name + "' is ignored: its group '" + state.group +
                         "' does not exist");
  return result;
}

NamedState RobotModel::namedState(const std::string& name) const
{
  NamedState result;
  std::string names;
  for (const NamedState& state : named_states_)
  {
    names += (names.empty() ? "" : ", ") + state.group + "/" + state.name;
    if (state.name != name && state.group + "/" + state.name != name)
      continue;
    if (result.name.empty())
      result = state;
    else
      merge(state, *this, result);
  }
  if (result.name.empty() && !srdf_collisions_.has_srdf)
    throw Error("there is no state '" + name + "', because the robot has no SRDF, which names states");
  if (result.name.empty())
    throw Error("the SRDF has no state '" + name + "'; " +
                (names.empty() ? "it names no states" : "its states: " + names));
  if (result.variables.empty())
    throw Error("the state '" + name + "' of the SRDF sets no variable: each of its joints is fixed, follows another " +
                "joint, or has a value that was ignored with a warning; name another state");
  return result;
}
}  // namespace gpu_planning_scene::core
