#include "model/robot_text.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "model/text/name_list.h"
#include "model/text/one_line.h"

namespace gpu_planning_scene::core
{
namespace
{
/// "elbow (-1.57 to 1.57)"; the name alone if there are no limits. The limits have so many digits that a request may
/// use them as values.
std::string textOf(const Variable& variable)
{
  if (!variable.bounded)
    return variable.name;
  char limits[64];
  std::snprintf(limits, sizeof limits, " (%.9g to %.9g)", variable.lower, variable.upper);
  return variable.name + limits;
}

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

std::vector<std::string> describeRobot(const RobotModel& robot)
{
  std::vector<std::string> lines;
  addLine(lines, "variables, with their limits in radians or metres: ", robot.variables(), textOf);
  addLine(
      lines, "groups: ", robot.groups(), [](const Group& group) { return group.name; });
  addLine(lines, "named states: ", robot.namedStates(),
          [](const NamedState& state) { return state.group + "/" + state.name; });
  return lines;
}
}  // namespace gpu_planning_scene::core
