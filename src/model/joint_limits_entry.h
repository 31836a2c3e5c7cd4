#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// One entry of joint_limits, with the members of MoveIt's joint_limits.yaml that concern positions.
struct JointLimitsEntry
{
  std::string variable;
  std::optional<bool> has_position_limits = {};
  std::optional<double> min_position = {};
  std::optional<double> max_position = {};
};

/// "; did you mean 'joint_limits'?" if the key at the top of a planning file is a misspelt joint_limits; else empty.
std::string misspeltJointLimits(const std::string& key);

/// "; did you mean 'max_position'?" if the key of an entry is a misspelt or another name of a position limit; else
/// empty. Other keys are those of limits that change no position.
std::string misspeltPositionLimit(const std::string& key);

/// The position limits of an entry; no value if it has none. MoveIt does not read has_position_limits. `warnings` (may
/// be null) gets a line if has_position_limits contradicts the limits.
std::optional<PositionLimits> positionLimits(const JointLimitsEntry& entry, const std::string& source,
                                             std::vector<std::string>* warnings);
}  // namespace gpu_planning_scene::core
