#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace gpu_planning_scene::core
{
/// Admits at most `most_inside` callers at a time, in the order of their arrival. At most `most_waiting` further
/// callers wait; all others are rejected.
class Admission
{
 public:
  Admission(std::size_t most_inside, std::size_t most_waiting) : most_inside_(most_inside), most_waiting_(most_waiting)
  {
  }

  /// The owner of a pass is admitted until the pass is destroyed.
  class Pass
  {
   public:
    /// Waits to be admitted. Throws Busy immediately if too many callers wait; throws Error after stop().
    explicit Pass(Admission& admission) : admission_(admission) { admission.enter(); }
    ~Pass() { admission_.leave(); }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

   private:
    Admission& admission_;
  };

  /// Admits no further caller. Waiting callers get an Error "shutting down".
  void stop();

 private:
  void enter();
  void leave();

  const std::size_t most_inside_;
  const std::size_t most_waiting_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::uint64_t came_ = 0;
  std::uint64_t left_ = 0;
  bool stopping_ = false;
};
}  // namespace gpu_planning_scene::core
