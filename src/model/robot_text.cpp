#include "model/robot_text.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "base/text/name_list.h"
#include "base/text/number_text.h"
#include "base/text/one_line.h"

namespace gpu_planning_scene::core
{
namespace
{
template <typename Item, typename Text>
void addLine(std::vector<std::string>& lines, const std::string& heading, const std::vector<Item>& items, Text text)
{
  if (items.empty())
    return;
  std::vector<std::string> names;
  std::transform(items.begin(), items.end(), std::back_inserter(names), text);
  lines.push_back(onOneLine(heading + nameList(names)));
}
}  // namespace

std::string describeVariable(const Variable& variable)
{
  if (!variable.bounded)
    return variable.name;
  return variable.name + " (" + numberText(variable.lower) + " to " + numberText(variable.upper) + ")";
}

std::vector<std::string> describeLimitSources(const RobotModel& robot)
{
  std::map<std::string, std::vector<std::string>> limited;  // by source
  for (const Variable& variable : robot.variables())
    if (!variable.limits_source.empty())
      limited[variable.limits_source].push_back(describeVariable(variable));
  std::vector<std::string> lines;
  for (const auto& [source, variables] : limited)
    lines.push_back(onOneLine("limits from " + source + ": " + nameList(variables)));
  return lines;
}

std::vector<std::string> describeRobot(const RobotModel& robot)
{
  std::vector<std::string> lines;
  addLine(lines, "variables, with their limits in radians or metres: ", robot.variables(), describeVariable);
  addLine(
      lines, "groups: ", robot.groups(), [](const Group& group) { return group.name; });
  addLine(lines, "named states: ", robot.namedStates(),
          [](const NamedState& state) { return state.group + "/" + state.name; });
  return lines;
}
}  // namespace gpu_planning_scene::core
