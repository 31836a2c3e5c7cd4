#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include <ros/console.h>

namespace gpu_planning_scene::detector
{
/// The logger of the detector, as MoveIt names those of its own detectors.
constexpr char kLogName[] = "collision_detection.gpu_planning_scene";

/// Limits a message to one per second. roscpp's own limits throw in a process that has not started ROS's time.
class LogLimit
{
 public:
  /// Whether the message may be logged now. Thread-safe.
  bool allows()
  {
    const std::int64_t now =
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
            .count();
    std::int64_t next = next_.load();
    return now >= next && next_.compare_exchange_strong(next, now + 1000);
  }

 private:
  std::atomic<std::int64_t> next_{0};  // milliseconds
};
}  // namespace gpu_planning_scene::detector
