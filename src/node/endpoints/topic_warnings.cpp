#include "node/endpoints/topic_warnings.h"

#include <chrono>
#include <map>
#include <mutex>

#include <ros/console.h>

#include "base/text/one_line.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::chrono::seconds kOccasion{10};
}  // namespace

void OccasionalWarning::log(const std::string& text)
{
  const auto now = std::chrono::steady_clock::now();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (logged_ && now - *logged_ < kOccasion)
      return;
    logged_ = now;
  }
  ROS_WARN_STREAM(shortLine(text));
}

void warnOfMessage(const std::vector<std::string>& warnings)
{
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kMaxTexts = 1000;
  static std::mutex mutex;
  static std::map<std::string, Clock::time_point> logged;
  const Clock::time_point now = Clock::now();
  for (const std::string& warning : warnings)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (logged.size() >= kMaxTexts)
        logged.clear();
      const auto [at, is_new] = logged.emplace(warning, now);
      if (!is_new && now - at->second < std::chrono::seconds(1))
        continue;
      at->second = now;
    }
    ROS_WARN_STREAM(shortLine(warning));
  }
}
}  // namespace gpu_planning_scene::core
