#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <queue>

namespace gpu_planning_scene::core
{
/// Consecutive states of a batch.
struct StateRange
{
  std::size_t begin;
  std::size_t count;
};

/// Parts of a batch on their way from the thread that produces their verdicts to the thread that uses them.
/// Thread-safe.
class PartQueue
{
 public:
  void add(const StateRange& part)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      parts_.push(part);
    }
    changed_.notify_one();
  }

  /// No part follows.
  void end()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ended_ = true;
    }
    changed_.notify_one();
  }

  /// Waits for the next part. No value if there is none.
  std::optional<StateRange> next()
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return ended_ || !parts_.empty(); });
    if (parts_.empty())
      return std::nullopt;
    const StateRange part = parts_.front();
    parts_.pop();
    return part;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::queue<StateRange> parts_;
  bool ended_ = false;
};
}  // namespace gpu_planning_scene::core
