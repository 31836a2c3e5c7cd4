#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// The message for a planner that is neither a configuration of ~planners nor a plugin. It suggests a similar name. A
/// plugin may be meant without its namespace, and upper and lower case do not count: "rrtconnect" suggests
/// "geometric::RRTConnect".
std::string unknownPlannerText(const std::string& name, const std::vector<std::string>& configs,
                               const std::vector<std::string>& plugins);
}  // namespace gpu_planning_scene::core
