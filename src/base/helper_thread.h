#pragma once

#include <atomic>
#include <functional>

#include <pthread.h>

namespace gpu_planning_scene::core
{
/// A thread that does a piece of work beside the thread that creates it. The destructor waits for its end.
///
/// It starts on another core than its creator, if there is one. Without this, Linux in a virtual machine often puts a
/// new thread behind its creator although another core is idle, because it regards a core that the host has halted as
/// busy. The new thread then waits until its creator loses the core: for 2.3 ms on two cores that had rested for 0.3 s,
/// and for 0.16 ms with this. Once created, the thread may run on all cores of its creator.
class HelperThread
{
 public:
  /// Throws std::system_error if the system cannot start a thread. An exception of the work ends the process.
  explicit HelperThread(std::function<void()> work);
  ~HelperThread();
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;

 private:
  static void* run(void* helper);

  const std::function<void()> work_;
  std::atomic<bool> may_end_{false};
  pthread_t thread_;
};
}  // namespace gpu_planning_scene::core
