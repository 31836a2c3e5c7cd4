#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The values of the robot's variables in the last 10 seconds, ordered by stamp. Each variable has its own stamps,
/// because several publishers may bring parts of the state. Not thread-safe.
class StateHistory
{
 public:
  static constexpr std::int64_t kKept = 10'000'000'000;  ///< nanoseconds before the newest stamp of a variable
  static constexpr std::int64_t kNear = 1'000'000'000;   ///< nanoseconds: the largest difference of setAt()
  static constexpr std::int64_t kFast = 250'000'000;     ///< nanoseconds between the values of a fast driver, at most
  /// Radians or metres: a variable that changes by no more within kFast stands still.
  static constexpr double kStands = 1e-3;

  explicit StateHistory(const RobotModel& robot);

  /// A stamp of 0 means "no stamp": the variable then has no history. If a value is more than kNear later than `stamp`,
  /// the clock was set back, and all later values are dropped.
  void add(std::size_t variable, double value, std::int64_t stamp);

  /// Sets each variable that has a history to its value at `stamp` (nanoseconds): on a straight line between the values
  /// before and after it, and for a quaternion the nearest value. Without a value after `stamp`, the last one counts if
  /// the variable stands still, or if its driver is slow; otherwise throws NotKnownYet, because a later one soon comes.
  /// The same holds before the first value, but there it throws Error for a variable that moves, and NotKnownYet if
  /// there is only one value. Throws Error if the nearest value is more than kNear away, or if `stamp` is before all
  /// kept values and older ones were dropped.
  void setAt(std::int64_t stamp, std::vector<double>& state) const;

 private:
  enum class Kind
  {
    Linear,
    Angle,      // a whole turn changes nothing
    Quaternion  // a component
  };
  struct Stamped
  {
    std::int64_t stamp;
    double value;
  };
  struct Values
  {
    std::string name;
    Kind kind = Kind::Linear;
    std::deque<Stamped> by_stamp = {};
    bool forgot = false;  // whether older values were dropped
  };

  static double valueAt(const Values& values, std::int64_t stamp);
  template <class Iterator>
  static bool moves(const Values& values, Iterator at, Iterator end);

  std::vector<Values> values_;
};
}  // namespace gpu_planning_scene::core
