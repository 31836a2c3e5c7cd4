#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Reads the limits of the joints in a YAML file for MoveIt's robot_description_planning/, for
/// RobotModelOptions::joint_limits:
///     joint_limits:
///       elbow: {has_position_limits: true, min_position: -1.5, max_position: 1.5}
///       wrist: {has_velocity_limits: true, max_velocity: 2, has_acceleration_limits: true, max_acceleration: 5}
///       base: {x: {min_position: -5, max_position: 5}}   # or base/x: a translation of a planar or floating joint
/// As in MoveIt, a limit of velocity or acceleration does not count if its flag is false. Limits of effort and jerk are
/// not read. `warnings` (may be null) gets a line if the file has no limits, and for default paddings and scales and
/// collision operations, which only the node applies. Throws Error with file and line if the file cannot be read, for a
/// limit that is not a finite number, and for a misspelt name of a limit.
std::vector<JointLimits> readJointLimits(const std::string& path, std::vector<std::string>* warnings = nullptr);

/// The same for the text of such a file. `name` takes the place of the path in messages.
std::vector<JointLimits> jointLimitsFromText(const std::string& text, const std::string& name,
                                             std::vector<std::string>* warnings = nullptr);
}  // namespace gpu_planning_scene::core
