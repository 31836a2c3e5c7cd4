#include "model/joint_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/math_constants.h"

// A value may exceed its limit by the rounding of a value with six decimals. A large angle is probably in degrees if it
// would then be within its limits. Own method.
namespace gpu_planning_scene::core
{
namespace
{
constexpr double kWrittenDecimals = 1e-6;  // radians or metres: values are often written with six decimals

constexpr double kTwoTurns = 4.0 * kPi;

std::string number(double value, int digits = 6)
{
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

/// The value with enough digits to differ from the variable's limits.
std::string shownValue(const Variable& variable, double value)
{
  const std::string rounded = number(value);
  const bool is_like_limit = rounded == number(variable.lower) || rounded == number(variable.upper);
  return is_like_limit ? number(value, 17) : rounded;
}

bool isAngle(const RobotModel& robot, int variable)
{
  for (const Joint& joint : robot.joints())
    if (joint.first_variable == variable && !joint.mimic)
      return joint.type == JointType::Revolute;
  return false;
}

bool isTranslation(const RobotModel& robot, int variable)
{
  for (const Joint& joint : robot.joints())
  {
    const int count = joint.type == JointType::Planar ? 2 : joint.type == JointType::Floating ? 3 : 0;
    if (variable >= joint.first_variable && variable < joint.first_variable + count)
      return true;
  }
  return false;
}

/// The range that the value is outside of, in words.
std::string rangeText(const RobotModel& robot, int index, double value)
{
  const Variable& variable = robot.variables()[static_cast<std::size_t>(index)];
  const std::string range = number(variable.lower) + " to " + number(variable.upper);
  const bool is_within = value >= variable.lower && value <= variable.upper;
  if (variable.bounded && !is_within)
    return "outside its limits " + range + (isAngle(robot, index) ? " rad" : "");
  if (isTranslation(robot, index))
    return "outside " + range +
           ", the range of translations without limits; set a larger unbounded_translation, or give the "
           "request a workspace";
  return "too large: it, or a joint that follows it, turns by more than " + number(kLargestProvenAngle) + " rad";
}

bool mayBeDegrees(const RobotModel& robot, int variable, double value)
{
  // A smaller value is unlikely to be in degrees.
  return std::abs(value) > kTwoTurns && isAngle(robot, variable) &&
         !isOutsideLimits(robot.variables()[static_cast<std::size_t>(variable)], value * kPi / 180.0);
}
/// The first translation that is beyond kExactRange.
std::optional<ValueOutsideLimits> findFarTranslation(const RobotModel& robot, const std::vector<int>& columns,
                                                     const double* rows, std::size_t count)
{
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (const double value = rows[row * columns.size() + k];
          std::abs(value) > kExactRange && isTranslation(robot, columns[k]))
        return ValueOutsideLimits{row, "joint '" + robot.variables()[static_cast<std::size_t>(columns[k])].name +
                                           "' is " + number(value) + "; answers are exact only within " +
                                           number(kExactRange) + " m of the origin of the planning frame"};
  return std::nullopt;
}
}  // namespace

bool isOutsideLimits(const Variable& variable, double value)
{
  return variable.bounded && (value < variable.lower - kWrittenDecimals || value > variable.upper + kWrittenDecimals);
}

std::optional<ValueOutsideLimits> findManyTurns(const RobotModel& robot, const std::vector<int>& columns,
                                                const double* rows, std::size_t count)
{
  const auto is_more_than_a_turn = [](double value) { return std::abs(value) > 2.0 * kPi; };
  if (std::none_of(rows, rows + count * columns.size(), is_more_than_a_turn))
    return std::nullopt;
  for (const Joint& joint : robot.joints())
  {
    const bool is_planar = joint.type == JointType::Planar;
    if (!is_planar && (joint.type != JointType::Continuous || joint.mimic))
      continue;
    const int angle = joint.first_variable + (is_planar ? 2 : 0);
    // A measured angle of a wheel or a wrist may be many turns, but it is seldom a whole number.
    const auto may_be_degrees = [&](double value)
    { return is_more_than_a_turn(value) && (is_planar || std::round(value) == value); };
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (std::size_t row = 0; columns[k] == angle && row < count; ++row)
        if (const double value = rows[row * columns.size() + k]; may_be_degrees(value))
          return ValueOutsideLimits{row, "joint '" + robot.variables()[static_cast<std::size_t>(angle)].name + "' is " +
                                             number(value) + " rad, more than one turn; " + number(value) +
                                             " degrees are " + number(value * kPi / 180.0) + " rad"};
  }
  return std::nullopt;
}

std::optional<ValueOutsideLimits> findDoubtfulValue(const RobotModel& robot, const std::vector<int>& columns,
                                                    const double* rows, std::size_t count)
{
  const auto outside = findValueOutsideLimits(robot, columns, rows, count);
  return outside ? outside : findManyTurns(robot, columns, rows, count);
}

void ValuesOutsideLimits::add(int variable, double value)
{
  if (count_++ == 0)
  {
    first_variable_ = variable;
    first_value_ = value;
  }
  if (!in_degrees_ && mayBeDegrees(robot_, variable, value))
  {
    in_degrees_ = variable;
    degrees_ = value;
  }
}

std::string ValuesOutsideLimits::text() const
{
  if (count_ == 0)
    return "";
  const auto variable = [this](int index) -> const Variable&
  { return robot_.variables()[static_cast<std::size_t>(index)]; };
  const Variable& first = variable(first_variable_);
  std::string line = "joint '" + first.name + "' is " + shownValue(first, first_value_) + ", " +
                     rangeText(robot_, first_variable_, first_value_);
  if (in_degrees_)
    line += "; values are in radians, and " +
            (in_degrees_ == first_variable_ && degrees_ == first_value_
                 ? ""
                 : "joint '" + variable(*in_degrees_).name + "' is " + number(degrees_) + ": ") +
            number(degrees_) + " degrees are " + number(degrees_ * kPi / 180.0) + " rad";
  if (count_ > 1)
    line += "; " + std::to_string(count_ - 1) + " more " + (count_ == 2 ? "value is" : "values are") +
            " outside the limits";
  return line;
}

std::optional<ValueOutsideLimits> findValueOutsideLimits(const RobotModel& robot, const std::vector<int>& columns,
                                                         const double* rows, std::size_t count)
{
  ValuesOutsideLimits outside(robot);
  std::size_t first_row = 0;
  for (std::size_t row = 0; row < count; ++row)
    for (const int column : columns)
      if (const double value = *rows++; isOutsideLimits(robot.variables()[static_cast<std::size_t>(column)], value))
      {
        if (outside.count() == 0)
          first_row = row;
        outside.add(column, value);
      }
  if (outside.count() == 0)
    return findFarTranslation(robot, columns, rows - count * columns.size(), count);
  return ValueOutsideLimits{first_row, outside.text()};
}

std::string otherValueOutsideLimits(const RobotModel& robot, const std::vector<int>& without, const double* state)
{
  std::vector<int> columns;
  std::vector<double> values;
  for (int i = 0; i < static_cast<int>(robot.variables().size()); ++i)
    if (std::find(without.begin(), without.end(), i) == without.end())
    {
      columns.push_back(i);
      values.push_back(state[i]);
    }
  const auto outside = findValueOutsideLimits(robot, columns, values.data(), 1);
  return outside ? outside->text : "";
}
}  // namespace gpu_planning_scene::core
