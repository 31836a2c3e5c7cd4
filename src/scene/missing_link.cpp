#include "scene/missing_link.h"

#include <algorithm>
#include <vector>

#include "base/text/name_list.h"
#include "base/text/nearest_key.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
std::string noLinkText(const RobotModel& robot, const std::string& name)
{
  std::vector<std::string> names;
  for (const Link& link : robot.links())
    names.push_back(link.name);
  const std::string start = "has no link '" + name + "'";
  if (const std::string suggestion = didYouMean(name, names); !suggestion.empty())
    return start + suggestion;
  constexpr std::size_t kListed = 30;
  const std::size_t listed = std::min(names.size(), kListed);
  const std::size_t more = names.size() - listed;
  names.resize(listed);
  return start + "; its links: " + nameList(names) + (more == 0 ? "" : " and " + std::to_string(more) + " more");
}

int requireLink(const RobotModel& robot, const std::string& name, const std::string& where)
{
  const int link = robot.linkIndex(name);
  if (link < 0)
    throw Error(where + ": robot '" + robot.name() + "' " + noLinkText(robot, name));
  return link;
}
}  // namespace gpu_planning_scene::core
