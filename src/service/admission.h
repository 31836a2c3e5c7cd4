#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace gpu_planning_scene::core
{
/// Admits at most `max_inside` callers at a time, in the order of their arrival. At most `max_waiting` further
/// callers wait; all others are rejected.
class Admission
{
 public:
  Admission(std::size_t max_inside, std::size_t max_waiting) : max_inside_(max_inside), max_waiting_(max_waiting) {}

  /// The owner of a pass is admitted until the pass is destroyed.
  class Pass
  {
   public:
    /// Waits to be admitted. Throws Busy immediately if too many callers wait; throws ShuttingDown after stop().
    explicit Pass(Admission& admission) : admission_(admission) { admission.enter(); }
    ~Pass() { admission_.leave(); }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

   private:
    Admission& admission_;
  };

  /// Admits no further caller. Waiting callers get ShuttingDown.
  void stop();

 private:
  void enter();
  void leave();

  const std::size_t max_inside_;
  const std::size_t max_waiting_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::uint64_t arrived_ = 0;
  std::uint64_t departed_ = 0;
  bool stopping_ = false;
};
}  // namespace gpu_planning_scene::core
