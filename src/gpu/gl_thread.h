#pragma once

#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <queue>
#include <string>
#include <thread>

#include "gpu/egl_context.h"

namespace gpu_planning_scene::core
{
/// A thread that owns an OpenGL context and runs one job after the other. A context is current on one thread only.
class GlThread
{
 public:
  /// Starts the thread and makes the context; throws Error as EglContext does.
  explicit GlThread(const std::string& device_selector);
  /// Finishes the queued jobs, then destroys the context.
  ~GlThread();

  /// Runs `job` on the thread, waits for it, and rethrows its exception here. Throws DeviceLost if the context was lost
  /// meanwhile, whether the job failed or not. Thread-safe.
  void run(const std::function<void()>& job) { start(job).get(); }

  /// The same without waiting. The future's `get` waits and throws. What `job` refers to must exist until then.
  std::future<void> start(std::function<void()> job);

  const Device& device() const { return device_; }

 private:
  void serve(const std::string& device_selector, std::promise<Device>& started);

  std::mutex mutex_;
  std::condition_variable wake_;
  std::queue<std::packaged_task<void()>> jobs_;
  bool stopping_ = false;
  Device device_;
  std::thread thread_;
};
}  // namespace gpu_planning_scene::core
