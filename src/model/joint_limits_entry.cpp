#include "model/joint_limits_entry.h"

#include <algorithm>
#include <sstream>

#include "base/text/nearest_key.h"

namespace gpu_planning_scene::core
{
namespace
{
const std::vector<std::string>& usedKeys()
{
  static const std::vector<std::string> keys = {"has_position_limits", "min_position", "max_position",
                                                "has_velocity_limits", "max_velocity", "has_acceleration_limits",
                                                "max_acceleration"};
  return keys;
}

/// The other keys of MoveIt and ros_control. Some of them are similar to a used key.
bool isOtherLimit(const std::string& key)
{
  for (const char* known :
       {"angle_wraparound", "has_soft_limits", "soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"})
    if (key == known)
      return true;
  for (const char* quantity : {"velocity", "acceleration", "deceleration", "jerk", "effort"})
    for (const std::string& known :
         {"has_" + std::string(quantity) + "_limits", "min_" + std::string(quantity), "max_" + std::string(quantity)})
      if (key == known)
        return true;
  return false;
}

/// Whether a word of the key, between underscores, says that it is a limit of a position: "max", "pos" or "upper".
bool soundsLikePositionLimit(const std::string& key)
{
  std::istringstream words(key);
  for (std::string word; std::getline(words, word, '_');)
    for (const char* known : {"min", "minimum", "max", "maximum", "low", "lower", "high", "upper", "pos", "position",
                              "positions", "limit", "limits", "range"})
      if (word == known)
        return true;
  return false;
}
}  // namespace

std::string misspeltJointLimits(const std::string& key)
{
  return key == "joint_limits" ? "" : didYouMean(key, {"joint_limits"});
}

JointLimitsMember memberOf(JointLimitsEntry& entry, const std::string& key)
{
  if (key == "has_position_limits")
    return {&entry.has_position_limits, nullptr};
  if (key == "has_velocity_limits")
    return {&entry.has_velocity_limits, nullptr};
  if (key == "has_acceleration_limits")
    return {&entry.has_acceleration_limits, nullptr};
  if (key == "min_position")
    return {nullptr, &entry.min_position};
  if (key == "max_position")
    return {nullptr, &entry.max_position};
  if (key == "max_velocity")
    return {nullptr, &entry.max_velocity};
  if (key == "max_acceleration")
    return {nullptr, &entry.max_acceleration};
  return {};
}

std::string misspeltLimit(const std::string& key)
{
  const std::vector<std::string>& keys = usedKeys();
  if (isOtherLimit(key) || std::find(keys.begin(), keys.end(), key) != keys.end())
    return "";
  const std::string meant = didYouMean(key, keys);
  for (const char* quantity : {"velocity", "acceleration"})
    if (meant.empty() && key.find(std::string(quantity, 3)) != std::string::npos)
      return "; the limit of " + std::string(quantity) + " is max_" + quantity;
  return meant.empty() && soundsLikePositionLimit(key) ? "; the limits of a position are min_position and max_position"
                                                       : meant;
}

std::optional<JointLimits> jointLimitsOf(const JointLimitsEntry& entry, const std::string& source,
                                         std::vector<std::string>* warnings)
{
  const bool has_positions = entry.min_position || entry.max_position;
  const auto warn = [&](const char* text)
  {
    if (warnings != nullptr)
      warnings->push_back(source + ": '" + entry.variable + "' " + text);
  };
  if (entry.has_position_limits && *entry.has_position_limits && !has_positions)
    warn("has neither min_position nor max_position, so its limits are those of the URDF");
  if (entry.has_position_limits && !*entry.has_position_limits && has_positions)
    warn(
        "has position limits although has_position_limits is false; they are used, as in MoveIt, which does not read "
        "has_position_limits");
  if (entry.has_acceleration_limits.value_or(false) && !entry.max_acceleration)
    warn("has no max_acceleration although has_acceleration_limits is true; it has no limit of acceleration");
  JointLimits limits{entry.variable, entry.min_position, entry.max_position, source};
  if (entry.has_velocity_limits.value_or(true))
    limits.max_velocity = entry.max_velocity;
  else
    limits.drops_velocity_limit = true;
  if (entry.has_acceleration_limits.value_or(true))
    limits.max_acceleration = entry.max_acceleration;
  if (!has_positions && !limits.max_velocity && !limits.max_acceleration && !limits.drops_velocity_limit)
    return std::nullopt;
  return limits;
}
}  // namespace gpu_planning_scene::core
