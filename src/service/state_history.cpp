#include "service/state_history.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"

namespace gpu_planning_scene::core
{
StateHistory::StateHistory(const RobotModel& robot)
{
  for (const Variable& variable : robot.variables())
    values_.push_back({variable.name});
  for (const Joint& joint : robot.joints())
  {
    if (joint.mimic)
      continue;
    const auto first = static_cast<std::size_t>(joint.first_variable);
    if (joint.type == JointType::Continuous)
      values_[first].kind = Kind::Angle;
    else if (joint.type == JointType::Planar)
      values_[first + 2].kind = Kind::Angle;
    else if (joint.type == JointType::Floating)
      for (std::size_t i = 3; i < 7; ++i)
        values_[first + i].kind = Kind::Quaternion;
  }
}

void StateHistory::add(std::size_t variable, double value, std::int64_t stamp)
{
  Values& values = values_[variable];
  std::deque<Stamped>& by_stamp = values.by_stamp;
  if (stamp == 0)
  {
    values.forgot = values.forgot || !by_stamp.empty();
    by_stamp.clear();
    return;
  }
  if (!by_stamp.empty() && by_stamp.back().stamp > stamp + kNear)
  {
    while (!by_stamp.empty() && by_stamp.back().stamp > stamp)
      by_stamp.pop_back();
    values.forgot = values.forgot && !by_stamp.empty();
  }
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

/// Whether the variable moves within kFast from its value `at`, in the direction of the iterators.
template <class Iterator>
bool StateHistory::moves(const Values& values, Iterator at, Iterator end)
{
  for (Iterator other = std::next(at); other != end && std::abs(at->stamp - other->stamp) <= kFast; ++other)
  {
    const double change =
        values.kind == Kind::Angle ? shortestAngularDistance(other->value, at->value) : at->value - other->value;
    if (std::abs(change) > kStands)
      return true;
  }
  return false;
}

/// `values` has at least one.
double StateHistory::valueAt(const Values& values, std::int64_t stamp)
{
  const std::deque<Stamped>& by_stamp = values.by_stamp;
  const auto after = std::lower_bound(by_stamp.begin(), by_stamp.end(), stamp,
                                      [](const Stamped& other, std::int64_t wanted) { return other.stamp < wanted; });
  if (after == by_stamp.begin() && values.forgot && after->stamp != stamp)
    throw Error("the value of '" + values.name + "' of " +
                numberText(1e-9 * static_cast<double>(by_stamp.back().stamp - stamp)) +
                " s before its newest one is not available: values are kept for " +
                std::to_string(kKept / 1'000'000'000) +
                " s, and only until a client or a message without a stamp sets the joint");
  const bool before_is_nearer =
      after == by_stamp.end() || (after != by_stamp.begin() && after->stamp - stamp >= stamp - std::prev(after)->stamp);
  const Stamped& nearest = before_is_nearer ? *std::prev(after) : *after;
  if (const std::int64_t difference = std::abs(nearest.stamp - stamp); difference > kNear)
    throw Error("the nearest known value of '" + values.name + "' is " +
                numberText(1e-9 * static_cast<double>(difference)) +
                " s away in time; publish joint_states at least every second, with the same clock");
  if (after == by_stamp.end())
  {
    if (moves(values, by_stamp.rbegin(), by_stamp.rend()))
      throw NotKnownYet("'" + values.name +
                        "' moves, and joint_states has brought no value of this time or later; publish it more often, "
                        "with the same clock");
    return nearest.value;
  }
  if (after == by_stamp.begin() && after->stamp != stamp)
  {
    if (by_stamp.size() == 1)
      throw NotKnownYet("'" + values.name + "' has only one value yet, so it may have moved since this time");
    if (moves(values, by_stamp.begin(), by_stamp.end()))
      throw Error("'" + values.name + "' moves, and joint_states has brought no value of this time or earlier");
  }
  if (after == by_stamp.begin() || after->stamp == stamp || values.kind == Kind::Quaternion)
    return nearest.value;
  const Stamped& before = *std::prev(after);
  const double share = static_cast<double>(stamp - before.stamp) / static_cast<double>(after->stamp - before.stamp);
  const double change =
      values.kind == Kind::Angle ? shortestAngularDistance(before.value, after->value) : after->value - before.value;
  return before.value + share * change;
}

void StateHistory::setAt(std::int64_t stamp, std::vector<double>& state) const
{
  for (std::size_t i = 0; i < values_.size(); ++i)
    if (!values_[i].by_stamp.empty())
      state[i] = valueAt(values_[i], stamp);
}
}  // namespace gpu_planning_scene::core
