#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// One entry of joint_limits, with the members of MoveIt's joint_limits.yaml that are used here.
struct JointLimitsEntry
{
  std::string variable;
  std::optional<bool> has_position_limits = {};
  std::optional<double> min_position = {};
  std::optional<double> max_position = {};
  std::optional<bool> has_velocity_limits = {};
  std::optional<double> max_velocity = {};
  std::optional<bool> has_acceleration_limits = {};
  std::optional<double> max_acceleration = {};
};

/// The member with this key: a flag or a number; null pointers if the key is another one.
struct JointLimitsMember
{
  std::optional<bool>* flag = nullptr;
  std::optional<double>* number = nullptr;
};
JointLimitsMember memberOf(JointLimitsEntry& entry, const std::string& key);

/// "; did you mean 'joint_limits'?" if the key at the top of a planning file is a misspelt joint_limits; else empty.
std::string misspeltJointLimits(const std::string& key);

/// "; did you mean 'max_position'?" if the key of an entry is a misspelt or another name of a limit that is used here;
/// else empty. Other keys are those of limits that change nothing here.
std::string misspeltLimit(const std::string& key);

/// The limits of an entry; no value if it has none. As in MoveIt, has_position_limits has no effect, and limits of
/// velocity and acceleration do not count if their flag is false. `warnings` (may be null) gets a line if a flag
/// contradicts the limits.
std::optional<JointLimits> jointLimitsOf(const JointLimitsEntry& entry, const std::string& source,
                                         std::vector<std::string>* warnings);
}  // namespace gpu_planning_scene::core
