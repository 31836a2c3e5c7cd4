#pragma once

#include <functional>
#include <memory>

namespace gpu_planning_scene::core
{
/// A thread that runs one job after the other, and that can be abandoned if a job does not end. A job may outlive its
/// caller, so it must own everything that it uses, by value or by shared pointer.
class AbandonableThread
{
 public:
  AbandonableThread();
  /// Waits until the thread has finished its jobs, unless it was given up.
  ~AbandonableThread();
  AbandonableThread(const AbandonableThread&) = delete;
  AbandonableThread& operator=(const AbandonableThread&) = delete;

  /// Runs `job` and waits for it for at most `seconds`. Rethrows the exception of the job here. Returns false if the
  /// job has not ended in time; the thread is then given up. Throws std::logic_error if the thread was given up before.
  /// Only one caller at a time.
  bool run(std::function<void()> job, double seconds);

  bool givenUp() const { return queue_ == nullptr; }

 private:
  struct Queue;
  std::shared_ptr<Queue> queue_;  // shared with the thread; null after the thread was given up
};
}  // namespace gpu_planning_scene::core
