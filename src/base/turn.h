#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace gpu_planning_scene::core
{
/// Only one thread at a time has the turn. In place of std::timed_mutex, whose timed functions the thread sanitizer of
/// GCC 12 does not know.
class Turn
{
 public:
  /// Waits for the turn, at most for this time. Returns whether the caller has it.
  bool takeFor(std::chrono::milliseconds time)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!free_.wait_for(lock, time, [this] { return !is_taken_; }))
      return false;
    is_taken_ = true;
    return true;
  }
  /// How often the turn has been given back.
  std::uint64_t given()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return given_;
  }
  /// Waits until no thread has the turn or it has been given back since given() was `before`, at most for this time.
  /// Returns whether this is so. Another thread may have taken the turn since.
  bool waitFor(std::uint64_t before, std::chrono::milliseconds time)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    return free_.wait_for(lock, time, [&] { return !is_taken_ || given_ != before; });
  }
  void give()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_taken_ = false;
    ++given_;
    free_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable free_;
  bool is_taken_ = false;
  std::uint64_t given_ = 0;
};
}  // namespace gpu_planning_scene::core
