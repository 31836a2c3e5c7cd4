#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// Logs warnings about messages on topics, which have no response. Each text is logged at most once per second, so that
/// a message that is published often does not fill the log. Thread-safe.
void warnOfMessage(const std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
