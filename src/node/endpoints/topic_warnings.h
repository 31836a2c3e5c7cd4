#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// Logs warnings about messages on topics, which have no response. Each text is logged at most once per second, so that
/// a message that is published often does not fill the log. Thread-safe.
void warnOfMessage(const std::vector<std::string>& warnings);

/// Logs warnings whose texts differ, for example by a value, at most every 10 seconds. (ROS_WARN_THROTTLE would stop
/// with a simulated clock.) Thread-safe.
class OccasionalWarning
{
 public:
  void log(const std::string& text);

 private:
  std::mutex mutex_;
  std::optional<std::chrono::steady_clock::time_point> logged_;
};
}  // namespace gpu_planning_scene::core
