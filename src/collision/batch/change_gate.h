#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace gpu_planning_scene::core
{
/// A shared mutex for std::shared_lock and std::lock_guard, in which a waiting change comes before later checks.
/// std::shared_mutex may let it wait for as long as any check runs.
class ChangeGate
{
 public:
  void lock_shared()  // NOLINT(readability-identifier-naming): the name that std::shared_lock uses
  {
    std::unique_lock<std::mutex> lock(mutex_);
    turn_.wait(lock, [this] { return changes_ == 0; });
    ++checks_;
  }
  void unlock_shared()  // NOLINT(readability-identifier-naming)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (--checks_ == 0 && changes_ != 0)
      turn_.notify_all();
  }
  void lock()
  {
    std::unique_lock<std::mutex> lock(mutex_);
    ++changes_;
    turn_.wait(lock, [this] { return checks_ == 0 && !is_changing_; });
    is_changing_ = true;
  }
  void unlock()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_changing_ = false;
    --changes_;
    turn_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable turn_;
  std::size_t checks_ = 0;   // that run
  std::size_t changes_ = 0;  // that run or wait
  bool is_changing_ = false;
};
}  // namespace gpu_planning_scene::core
