#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The largest angle of a joint, in radians, at which motions are proven free. Doubles resolve 1.2e-10 rad there; at
/// larger angles, rounding would move a body by more than the bound of a motion allows.
constexpr double kLargestProvenAngle = 1e6;

/// The range of coordinates in the planning frame, in metres, within which answers are exact (docs/error_bounds.md).
constexpr double kExactRange = 1000.0;

/// True if the variable has limits and the value is outside them by more than the rounding of a value that is written
/// with six decimals: 1e-6 (radians, metres).
bool isOutsideLimits(const Variable& variable, double value);

/// Collects values that are outside their joint limits or outside another range of their variables, and describes them
/// in one line.
class ValuesOutsideLimits
{
 public:
  explicit ValuesOutsideLimits(const RobotModel& robot) : robot_(robot) {}

  /// Adds a value that is outside the limits of its variable; or, in a variable without limits, a translation outside
  /// its range, or an angle beyond kLargestProvenAngle, also of a joint that follows it. Radians or metres.
  void add(int variable, double value);

  std::size_t count() const { return count_; }
  /// The first joint with its value and its limits, and the number of further values. If any of the values would be
  /// within its limits as degrees, the line says so. Empty without values.
  std::string text() const;

 private:
  const RobotModel& robot_;
  std::size_t count_ = 0;
  int first_variable_ = -1;
  double first_value_ = 0.0;
  std::optional<int> in_degrees_;  // the first variable whose value would be within its limits as degrees
  double degrees_ = 0.0;           // the value of that variable
};

/// The first value of a table that is outside its joint limits; or, if all are within them, the first translation of a
/// planar or floating joint beyond kExactRange.
struct ValueOutsideLimits
{
  std::size_t row;
  /// The line of ValuesOutsideLimits for all such values of the table, or a line about the range or the angle.
  std::string text;
};

/// The first angle that may be in degrees although it has no limits: of a planar joint, more than one turn; of a
/// continuous joint, a whole number of more than one turn. For values that a person gives: a measured angle may be any
/// number of turns. `rows`: `count` rows of values for the variables `columns`.
std::optional<ValueOutsideLimits> findManyTurns(const RobotModel& robot, const std::vector<int>& columns,
                                                const double* rows, std::size_t count);

/// findValueOutsideLimits, or else findManyTurns.
std::optional<ValueOutsideLimits> findDoubtfulValue(const RobotModel& robot, const std::vector<int>& columns,
                                                    const double* rows, std::size_t count);

/// `rows`: `count` rows of values for the variables `columns`. No value: nothing is outside the limits by more than
/// 1e-6 (radians, metres), or beyond kExactRange.
std::optional<ValueOutsideLimits> findValueOutsideLimits(const RobotModel& robot, const std::vector<int>& columns,
                                                         const double* rows, std::size_t count);

/// The line of findValueOutsideLimits for the variables of a full state that are not in `without`, for example those
/// that a request does not name; empty if there is none.
std::string otherValueOutsideLimits(const RobotModel& robot, const std::vector<int>& without, const double* state);
}  // namespace gpu_planning_scene::core
