#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <vector>

#include <gtest/gtest.h>

namespace gpu_planning_scene::core
{
/// The node's use of memory, as its diagnostics report it. Thread-safe.
class MemoryRecord
{
 public:
  void add(double bytes)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    bytes_.push_back(bytes);
  }

  /// Prints the least memory of the second and of the last quarter, and fails the test if it has grown. While no device
  /// is open, the node uses least: an open device on llvmpipe needs some 300 MB more. A run of less than two minutes
  /// fails no test: it may never be without a device for part of a quarter, and the address sanitizer keeps the first
  /// 256 MB that are freed.
  void expectFlat(double seconds)
  {
    const double early = least(0.25, 0.5);
    const double late = least(0.75, 1.0);
    std::printf("least memory: %.1f MiB in the second quarter, %.1f MiB in the last\n", early / 1048576.0,
                late / 1048576.0);
    if (seconds >= 120.0)
      EXPECT_LT(late, 1.1 * early + 8e6);
  }

 private:
  /// `from` and `to` are fractions of the run.
  double least(double from, double to)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto at = [this](double fraction)
    { return bytes_.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(bytes_.size())); };
    return at(from) == at(to) ? 0.0 : *std::min_element(at(from), at(to));
  }

  std::mutex mutex_;
  std::vector<double> bytes_;
};
}  // namespace gpu_planning_scene::core
