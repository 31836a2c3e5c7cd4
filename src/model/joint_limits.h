#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The first value of a table that is outside its joint limits.
struct ValueOutsideLimits
{
  std::size_t row;
  /// One line: the joint, the value, the limits, and the number of further such values. The line says so if the value
  /// would be within the limits as degrees.
  std::string text;
};

/// `rows`: `count` rows of values for the variables `columns`. No value: nothing is outside the limits by more than
/// 1e-6 (radians, metres).
std::optional<ValueOutsideLimits> findValueOutsideLimits(const RobotModel& robot, const std::vector<int>& columns,
                                                         const double* rows, std::size_t count);
}  // namespace gpu_planning_scene::core
