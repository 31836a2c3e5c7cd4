#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace gpu_planning_scene::core
{
/// The robot's states of the last 10 seconds, ordered by stamp. Not thread-safe.
class StateHistory
{
 public:
  static constexpr std::int64_t kKept = 10'000'000'000;  ///< nanoseconds before the newest stamp

  /// A stamp of 0 means "no stamp": the state is not kept. If the stamp is more than kKept before the newest one (the
  /// clock was set back), all other states are dropped.
  void add(std::int64_t stamp, const std::vector<double>& state);

  static constexpr std::int64_t kNear = 1'000'000'000;  ///< nanoseconds: the largest difference of nearest()

  /// The state whose stamp (nanoseconds) is nearest; null if there is none. Throws Error if its stamp differs by more
  /// than kNear, or if `stamp` is before all kept states and older states were dropped.
  const std::vector<double>* nearest(std::int64_t stamp) const;

 private:
  struct Stamped
  {
    std::int64_t stamp;
    std::vector<double> state;
  };
  std::deque<Stamped> states_;  // ordered by stamp
  bool forgot_ = false;         // whether older states were dropped
};
}  // namespace gpu_planning_scene::core
