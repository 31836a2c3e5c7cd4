#include "client/call_limit.h"

#include <algorithm>
#include <sstream>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kCentury = 3.2e9;  // seconds
constexpr std::chrono::milliseconds kLook{
    50};  // between two looks at the limit: a cancelled call ends within this time
}  // namespace

std::chrono::steady_clock::duration durationOf(double seconds)
{
  using Duration = std::chrono::steady_clock::duration;
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(std::min(seconds, kCentury)));
}

CallLimit::CallLimit(double seconds, const std::function<bool()>& is_cancelled)
  : seconds_(seconds), end_(std::chrono::steady_clock::now() + durationOf(seconds)), is_cancelled_(is_cancelled)
{
}

int CallLimit::wait() const
{
  if (is_cancelled_ && is_cancelled_())
    throw Cancelled();
  const auto left = end_ - std::chrono::steady_clock::now();
  if (left <= left.zero())
  {
    std::ostringstream text;
    text << "the node has not answered within " << seconds_ << " s";
    throw NoAnswer(text.str());
  }
  return std::max(
      1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(std::min<decltype(left)>(left, kLook)).count()));
}
}  // namespace gpu_planning_scene::core
