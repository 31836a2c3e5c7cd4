#include "model/joint_limits_entry.h"

#include <algorithm>
#include <sstream>

#include "model/text/nearest_key.h"

namespace gpu_planning_scene::core
{
namespace
{
const std::vector<std::string>& positionKeys()
{
  static const std::vector<std::string> keys = {"has_position_limits", "min_position", "max_position"};
  return keys;
}

/// The other keys of MoveIt and ros_control. Some of them are similar to a key of a position limit.
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

std::string misspeltPositionLimit(const std::string& key)
{
  const std::vector<std::string>& keys = positionKeys();
  if (isOtherLimit(key) || std::find(keys.begin(), keys.end(), key) != keys.end())
    return "";
  const std::string meant = didYouMean(key, keys);
  return meant.empty() && soundsLikePositionLimit(key) ? "; the limits of a position are min_position and max_position"
                                                       : meant;
}

std::optional<PositionLimits> positionLimits(const JointLimitsEntry& entry, const std::string& source,
                                             std::vector<std::string>* warnings)
{
  const bool has_limits = entry.min_position || entry.max_position;
  const auto warn = [&](const char* text)
  {
    if (warnings != nullptr)
      warnings->push_back(source + ": '" + entry.variable + "' " + text);
  };
  if (entry.has_position_limits && *entry.has_position_limits && !has_limits)
    warn("has neither min_position nor max_position, so its limits are those of the URDF");
  if (entry.has_position_limits && !*entry.has_position_limits && has_limits)
    warn(
        "has position limits although has_position_limits is false; they are used, as in MoveIt, which does not read "
        "has_position_limits");
  if (!has_limits)
    return std::nullopt;
  return PositionLimits{entry.variable, entry.min_position, entry.max_position, source};
}
}  // namespace gpu_planning_scene::core
