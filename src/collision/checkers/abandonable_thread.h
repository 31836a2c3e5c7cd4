#pragma once

#include <functional>
#include <memory>

namespace gpu_planning_scene::core
{
/// A thread that does one job after the other, and that can be left behind where a job does not end. A job must hold
/// all that it uses by value or by shared pointer: it may outlive its caller.
class AbandonableThread
{
 public:
  AbandonableThread();
  /// Waits for the job that runs, and for those that wait, unless the thread was given up.
  ~AbandonableThread();
  AbandonableThread(const AbandonableThread&) = delete;
  AbandonableThread& operator=(const AbandonableThread&) = delete;

  /// Runs `job` and waits at most so long; what it throws is thrown here. False: it has not ended, and the thread is
  /// given up. Throws std::logic_error for one that was given up before. One caller at a time.
  bool run(std::function<void()> job, double seconds);

  bool givenUp() const { return queue_ == nullptr; }

 private:
  struct Queue;
  std::shared_ptr<Queue> queue_;  // the thread has it too; null where it was given up
};
}  // namespace gpu_planning_scene::core
