#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace gpu_planning_scene::core
{
/// Lets a few at a time in, in the order in which they come. So many others wait; the rest is turned away.
class Admission
{
 public:
  Admission(std::size_t most_inside, std::size_t most_waiting) : most_inside_(most_inside), most_waiting_(most_waiting)
  {
  }

  /// Whoever has one is inside.
  class Pass
  {
   public:
    /// Waits to be let in. Throws Busy at once where too many wait, Error after stop().
    explicit Pass(Admission& admission) : admission_(admission) { admission.enter(); }
    ~Pass() { admission_.leave(); }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

   private:
    Admission& admission_;
  };

  /// Lets nobody in any more; who waits gets an Error "shutting down".
  void stop();

 private:
  void enter();
  void leave();

  const std::size_t most_inside_;
  const std::size_t most_waiting_;
  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::uint64_t came_ = 0;
  std::uint64_t left_ = 0;
  bool stopping_ = false;
};
}  // namespace gpu_planning_scene::core
