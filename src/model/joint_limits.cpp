#include "model/joint_limits.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "model/math_constants.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kWrittenDecimals = 1e-6;  // radians or metres: values are often written with six decimals

constexpr double kTwoTurns = 4.0 * kPi;

bool isOutside(const Variable& variable, double value)
{
  return variable.bounded && (value < variable.lower - kWrittenDecimals || value > variable.upper + kWrittenDecimals);
}

std::string text(double value)
{
  std::array<char, 32> digits;
  std::snprintf(digits.data(), digits.size(), "%.6g", value);
  return digits.data();
}

bool isAngle(const RobotModel& robot, int variable)
{
  for (const Joint& joint : robot.joints())
    if (joint.first_variable == variable && !joint.mimic)
      return joint.type == JointType::Revolute;
  return false;
}

/// `value` is outside the limits of the variable.
std::string describe(const RobotModel& robot, int index, double value)
{
  const Variable& variable = robot.variables()[static_cast<std::size_t>(index)];
  const bool is_angle = isAngle(robot, index);
  const double radians = value * kPi / 180.0;
  // A smaller value is hardly meant as degrees.
  const bool may_be_degrees = is_angle && std::abs(value) > kTwoTurns && !isOutside(variable, radians);
  return "joint '" + variable.name + "' is " + text(value) + ", outside its limits " + text(variable.lower) + " to " +
         text(variable.upper) + (is_angle ? " rad" : "") +
         (may_be_degrees ? "; values are in radians, and " + text(value) + " degrees are " + text(radians) + " rad"
                         : "");
}
}  // namespace

std::optional<ValueOutsideLimits> findValueOutsideLimits(const RobotModel& robot, const std::vector<int>& columns,
                                                         const double* rows, std::size_t count)
{
  std::size_t outside = 0;
  ValueOutsideLimits first = {0, ""};
  for (std::size_t row = 0; row < count; ++row)
    for (const int column : columns)
      if (const double value = *rows++;
          isOutside(robot.variables()[static_cast<std::size_t>(column)], value) && outside++ == 0)
        first = {row, describe(robot, column, value)};
  if (outside == 0)
    return std::nullopt;
  if (outside > 1)
    first.text += "; " + std::to_string(outside - 1) + " more " + (outside == 2 ? "value is" : "values are") +
                  " outside the limits";
  return first;
}
}  // namespace gpu_planning_scene::core
