#pragma once

#include <algorithm>
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

inline bool contains(const std::vector<std::string>& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}
}  // namespace gpu_planning_scene::core
