#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace gpu_planning_scene::core
{
/// The values of the robot's variables in the last 10 seconds, ordered by stamp. Each variable has its own stamps,
/// because several publishers may bring parts of the state. Not thread-safe.
class StateHistory
{
 public:
  static constexpr std::int64_t kKept = 10'000'000'000;  ///< nanoseconds before the newest stamp of a variable
  static constexpr std::int64_t kNear = 1'000'000'000;   ///< nanoseconds: the largest difference of setNearest()

  /// `names`: of the variables, for messages.
  explicit StateHistory(std::vector<std::string> names) : names_(std::move(names)), values_(names_.size()) {}

  /// A stamp of 0 means "no stamp": the variable then has no history. If a value is more than kNear later than `stamp`,
  /// the clock was set back, and all later values are dropped.
  void add(std::size_t variable, double value, std::int64_t stamp);

  /// Sets each variable that has a history to its value at the nearest stamp (nanoseconds). Throws Error if this stamp
  /// differs by more than kNear, or if `stamp` is before all kept values and older ones were dropped.
  void setNearest(std::int64_t stamp, std::vector<double>& state) const;

 private:
  struct Stamped
  {
    std::int64_t stamp;
    double value;
  };
  struct Values
  {
    std::deque<Stamped> by_stamp;
    bool forgot = false;  // whether older values were dropped
  };

  static const Stamped& nearest(const Values& values, std::int64_t stamp);

  std::vector<std::string> names_;
  std::vector<Values> values_;
};
}  // namespace gpu_planning_scene::core
