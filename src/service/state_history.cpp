#include "service/state_history.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
void StateHistory::add(std::size_t variable, double value, std::int64_t stamp)
{
  Values& values = values_[variable];
  std::deque<Stamped>& by_stamp = values.by_stamp;
  if (stamp == 0)
  {
    values = {};
    return;
  }
  if (!by_stamp.empty() && by_stamp.back().stamp > stamp + kNear)
    while (!by_stamp.empty() && by_stamp.back().stamp > stamp)
      by_stamp.pop_back();
  values.forgot = values.forgot && !by_stamp.empty();
  const auto at = std::lower_bound(by_stamp.begin(), by_stamp.end(), stamp,
                                   [](const Stamped& other, std::int64_t wanted) { return other.stamp < wanted; });
  if (at != by_stamp.end() && at->stamp == stamp)
    at->value = value;
  else
    by_stamp.insert(at, {stamp, value});
  while (by_stamp.front().stamp < by_stamp.back().stamp - kKept)
  {
    by_stamp.pop_front();
    values.forgot = true;
  }
}

/// `values` has at least one.
const StateHistory::Stamped& StateHistory::nearest(const Values& values, std::int64_t stamp)
{
  const std::deque<Stamped>& by_stamp = values.by_stamp;
  const auto after = std::lower_bound(by_stamp.begin(), by_stamp.end(), stamp,
                                      [](const Stamped& other, std::int64_t wanted) { return other.stamp < wanted; });
  if (after == by_stamp.begin() && values.forgot && after->stamp != stamp)
    throw Error("the robot's state of " + std::to_string((by_stamp.back().stamp - stamp) / 1'000'000'000) +
                " s ago is not available; the last " + std::to_string(kKept / 1'000'000'000) + " s are kept");
  if (after == by_stamp.end() || (after != by_stamp.begin() && after->stamp - stamp >= stamp - std::prev(after)->stamp))
    return *std::prev(after);
  return *after;
}

void StateHistory::setNearest(std::int64_t stamp, std::vector<double>& state) const
{
  for (std::size_t i = 0; i < values_.size(); ++i)
  {
    if (values_[i].by_stamp.empty())
      continue;
    const Stamped& found = nearest(values_[i], stamp);
    if (const std::int64_t difference = std::abs(found.stamp - stamp); difference > kNear)
      throw Error("the nearest known value of '" + names_[i] + "' is " +
                  numberText(1e-9 * static_cast<double>(difference)) +
                  " s away in time; publish joint_states at least every second, with the same clock");
    state[i] = found.value;
  }
}
}  // namespace gpu_planning_scene::core
