#include "scene/missing_link.h"

#include <algorithm>
#include <vector>

#include "scene/nearest_key.h"

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
  std::string list;
  for (std::size_t i = 0; i < listed; ++i)
    list += (list.empty() ? "" : ", ") + names[i];
  if (listed < names.size())
    list += " and " + std::to_string(names.size() - listed) + " more";
  return start + "; its links: " + list;
}
}  // namespace gpu_planning_scene::core
