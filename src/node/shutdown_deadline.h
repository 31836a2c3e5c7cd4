#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace gpu_planning_scene::core
{
/// Ends the process with exit code 1 if this object still exists after `seconds`. A thread that hangs in a device
/// cannot be stopped, and roslaunch would kill the process some seconds later.
class ShutdownDeadline
{
 public:
  explicit ShutdownDeadline(double seconds);
  ~ShutdownDeadline();
  ShutdownDeadline(const ShutdownDeadline&) = delete;
  ShutdownDeadline& operator=(const ShutdownDeadline&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool over_ = false;
  std::thread thread_;
};
}  // namespace gpu_planning_scene::core
