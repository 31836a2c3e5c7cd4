#include "planners/unknown_planner.h"

#include <algorithm>
#include <cctype>

#include "base/text/name_list.h"
#include "base/text/nearest_key.h"

namespace gpu_planning_scene::core
{
namespace
{
std::string inLowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// "RRTConnect" of "geometric::RRTConnect" and "BatchRrtConnect" of "gpu_planning_scene/BatchRrtConnect".
std::string withoutNamespace(const std::string& name)
{
  return name.substr(name.find_last_of(":/") + 1);
}

std::string nearestPlanner(const std::string& name, const std::vector<std::string>& known)
{
  const auto nearest = [&known](const std::string& word, const auto& shortened)
  {
    std::vector<std::string> words;
    for (const std::string& one : known)
      words.push_back(inLowerCase(shortened(one)));
    const auto found = std::find(words.begin(), words.end(), nearestKey(inLowerCase(word), words));
    return found == words.end() ? std::string() : known[static_cast<std::size_t>(found - words.begin())];
  };
  const std::string whole = nearest(name, [](const std::string& one) { return one; });
  return whole.empty() ? nearest(withoutNamespace(name), withoutNamespace) : whole;
}
}  // namespace

std::string unknownPlannerText(const std::string& name, const std::vector<std::string>& configs,
                               const std::vector<std::string>& plugins)
{
  std::vector<std::string> known = configs;
  known.insert(known.end(), plugins.begin(), plugins.end());
  const std::string nearest = nearestPlanner(name, known);
  return "planner '" + name + "' is " +
         (configs.empty() ? "not a plugin" : "neither in the planner_configs of ~planners nor a plugin") +
         (configs.empty() ? "" : "; planner_configs: " + nameList(configs)) + "; plugins: " + nameList(plugins) +
         (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
}
}  // namespace gpu_planning_scene::core
