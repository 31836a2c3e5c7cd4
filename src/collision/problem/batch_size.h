#pragma once

#include <algorithm>
#include <cstddef>

namespace gpu_planning_scene::core
{
/// Adapts the number of states in a batch, so that a batch takes about a given time. Short batches keep the device
/// available to others, and a call can be stopped between two batches. Own method: doubles the number while batches are
/// short, and computes it from the measured rate after a batch that took too long.
class BatchSize
{
 public:
  struct Limits
  {
    double seconds;       ///< wanted duration of a batch
    std::size_t first;    ///< states of the first batch; its duration is not known before
    std::size_t min = 1;  ///< states
    std::size_t max;      ///< states, at least 1
  };

  explicit BatchSize(const Limits& limits)
    : limits_(limits), capacity_(limits.max), size_(std::min(limits.first, limits.max))
  {
  }

  std::size_t size() const { return size_; }

  /// Changes Limits::max.
  void setMax(std::size_t max)
  {
    limits_.max = capacity_ = max;
    size_ = std::min(size_, capacity_);
  }

  /// The next batches differ from the last ones, for example because the scene has changed: begins as at first.
  void restart() { size_ = std::min(limits_.first, capacity_); }

  /// Reports that a batch of `count` states took `seconds`. Only a batch that took too long makes the next ones
  /// smaller: the fixed costs of a short batch say little about a full one. Only a full batch makes the next ones
  /// larger.
  void took(std::size_t count, double seconds)
  {
    if (count == 0)
      return;
    // A batch that was too large says little about much later batches, so its limit is raised again.
    if (++good_batches_ >= kBatchesToForget)
    {
      capacity_ = std::min(limits_.max, 2 * capacity_);
      good_batches_ = 0;
    }
    const double wanted = static_cast<double>(count) * limits_.seconds / std::max(seconds, 1e-6);
    if (seconds > limits_.seconds)
      size_ = std::min(capacity_, std::max(limits_.min, static_cast<std::size_t>(wanted)));
    else if (count == size_ && wanted >= 2.0 * static_cast<double>(count))
      size_ = std::min(capacity_, 2 * size_);
  }

  /// Reports that a batch of `count` states did not fit into the device's lists. The next batches are probably similar,
  /// so they get at most half as many states.
  void tooLarge(std::size_t count)
  {
    capacity_ = std::max<std::size_t>(1, std::min(capacity_, (count + 1) / 2));
    size_ = std::min(size_, capacity_);
    good_batches_ = 0;
  }

 private:
  static constexpr int kBatchesToForget = 8;

  Limits limits_;
  std::size_t capacity_;  // smaller than Limits::max for some time after a batch was too large
  std::size_t size_;      // at most capacity_
  int good_batches_ = 0;
};
}  // namespace gpu_planning_scene::core
