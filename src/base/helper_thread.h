#pragma once

#include <atomic>
#include <functional>

#include <pthread.h>

namespace gpu_planning_scene::core
{
/// A thread that does a piece of work beside the thread that creates it. The destructor waits for its end.
///
/// It starts on another core than its creator, if there is one. In a virtual machine, Linux may regard a core that the
/// host has halted as busy. It then puts a new thread on the core of its creator, where the thread waits until the
/// creator loses the core: for 2.3 ms on two cores that had rested for 0.3 s, and with this class for 0.16 ms. Once
/// created, the thread may run on all cores of its creator.
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
  std::atomic<bool> may_end_{false};  // the creator has set the cores of the thread
  pthread_t thread_;
};
}  // namespace gpu_planning_scene::core
