#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <vector>

#include "base/seconds_since.h"

namespace gpu_planning_scene::core::benchmark
{
/// The value that a share of `share` of all values does not exceed; NaN without values.
inline double percentile(std::vector<double> values, double share)
{
  if (values.empty())
    return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

/// For an even number of values, the mean of the two middle values. NaN without values.
inline double median(std::vector<double> values)
{
  if (values.empty())
    return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

/// Time since construction: wall time, and CPU time of the process on all cores.
class Stopwatch
{
 public:
  double seconds() const { return secondsSince(start_); }
  double cpuSeconds() const { return static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC; }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::clock_t cpu_ = std::clock();
};

template <class Work>
double secondsOf(const Work& work)
{
  const auto start = std::chrono::steady_clock::now();  // and not a Stopwatch: reading the CPU time takes 0.4 us
  work();
  return secondsSince(start);
}
}  // namespace gpu_planning_scene::core::benchmark
