#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>

namespace gpu_planning_scene::core
{
/// A node has not answered a call. The text says why.
class NoAnswer : public std::runtime_error
{
 public:
  using std::runtime_error::runtime_error;
};

/// Seconds as the duration of a steady clock. Larger numbers than the clock can count, and infinity, become a century.
std::chrono::steady_clock::duration durationOf(double seconds);

/// How long a call may wait.
class CallLimit
{
 public:
  /// `is_cancelled` may be empty, and must live as long as this object.
  CallLimit(double seconds, const std::function<bool()>& is_cancelled);

  /// The time until the next look at this limit, in milliseconds: at least 1. Throws NoAnswer after the limit, and
  /// Cancelled.
  int wait() const;

 private:
  const double seconds_;
  const std::chrono::steady_clock::time_point end_;
  const std::function<bool()>& is_cancelled_;
};
}  // namespace gpu_planning_scene::core
