#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace gpu_planning_scene::core
{
/// Ends the process, with an exit code of 1, if it still lives after so many seconds: what runs then, on a device that
/// hangs, say, cannot be ended by itself, and whoever started the process would kill it some seconds later.
class EndDeadline
{
 public:
  explicit EndDeadline(double seconds);
  ~EndDeadline();
  EndDeadline(const EndDeadline&) = delete;
  EndDeadline& operator=(const EndDeadline&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool over_ = false;
  std::thread thread_;
};
}  // namespace gpu_planning_scene::core
