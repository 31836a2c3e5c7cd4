#pragma once

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <vector>

namespace gpu_planning_scene::core
{
/// The latencies of answers. Thread-safe.
class Latencies
{
 public:
  void add(double seconds)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    seconds_.push_back(seconds);
  }

  void print()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::sort(seconds_.begin(), seconds_.end());
    const auto milliseconds = [this](double share)
    {
      return seconds_.empty()
                 ? 0.0
                 : 1e3 * seconds_[static_cast<std::size_t>(share * static_cast<double>(seconds_.size() - 1))];
    };
    std::printf("latency: p50 %.1f ms, p99 %.1f ms, max %.1f ms\n", milliseconds(0.5), milliseconds(0.99),
                milliseconds(1.0));
  }

 private:
  std::mutex mutex_;
  std::vector<double> seconds_;
};
}  // namespace gpu_planning_scene::core
