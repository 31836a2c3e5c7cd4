#include "service/state_history.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
void StateHistory::add(std::int64_t stamp, const std::vector<double>& state)
{
  if (stamp == 0)
    return;
  if (!states_.empty() && stamp < states_.back().stamp - kKept)
  {
    states_.clear();
    forgot_ = false;
  }
  const auto after = std::upper_bound(states_.begin(), states_.end(), stamp,
                                      [](std::int64_t value, const Stamped& other) { return value < other.stamp; });
  states_.insert(after, {stamp, state});
  while (states_.front().stamp < states_.back().stamp - kKept)
  {
    states_.pop_front();
    forgot_ = true;
  }
}

const std::vector<double>* StateHistory::nearest(std::int64_t stamp) const
{
  if (states_.empty())
    return nullptr;
  const auto after = std::lower_bound(states_.begin(), states_.end(), stamp,
                                      [](const Stamped& state, std::int64_t value) { return state.stamp < value; });
  if (after == states_.begin() && forgot_ && after->stamp != stamp)
    throw Error("the robot's state of " + std::to_string((states_.back().stamp - stamp) / 1'000'000'000) +
                " s ago is not available; the last " + std::to_string(kKept / 1'000'000'000) + " s are kept");
  auto nearest = after;
  if (after == states_.end() || (after != states_.begin() && after->stamp - stamp >= stamp - std::prev(after)->stamp))
    nearest = std::prev(after);
  if (const std::int64_t difference = std::abs(nearest->stamp - stamp); difference > kNear)
    throw Error("the nearest known state of the robot is " + numberText(1e-9 * static_cast<double>(difference)) +
                " s away in time; publish joint_states at least every second, with the same clock");
  return &nearest->state;
}
}  // namespace gpu_planning_scene::core
