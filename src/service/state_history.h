#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace gpu_planning_scene::core
{
/// The robot's states of the last seconds, by their stamps. Not thread-safe.
class StateHistory
{
 public:
  static constexpr std::int64_t kKept = 10'000'000'000;  ///< nanoseconds back from the newest

  /// A stamp of 0 is none, and is not kept. A clock that was set back begins anew.
  void add(std::int64_t stamp, const std::vector<double>& state);

  /// The one whose stamp (nanoseconds) is nearest; null where there is none at all. Throws Error: longer ago than what
  /// is kept.
  const std::vector<double>* nearest(std::int64_t stamp) const;

 private:
  struct Stamped
  {
    std::int64_t stamp;
    std::vector<double> state;
  };
  std::deque<Stamped> states_;  // by stamp
  bool forgot_ = false;         // there were older ones
};
}  // namespace gpu_planning_scene::core
