#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// The names as a message lists them: "a, b, c".
inline std::string nameList(const std::vector<std::string>& names)
{
  std::string list;
  for (const std::string& name : names)
    list += (list.empty() ? "" : ", ") + name;
  return list;
}
}  // namespace gpu_planning_scene::core
