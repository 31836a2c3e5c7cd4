#include "service/admission.h"

#include <string>

#include "service/busy.h"

namespace gpu_planning_scene::core
{
void Admission::stop()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
}

/// Callers are numbered and admitted in the order of their arrival: number n is admitted when n < left_ + most_inside_.
void Admission::enter()
{
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t here = came_ - left_;
  if (!stopping_ && here >= most_inside_ + most_waiting_)
    throw Busy("busy: " + std::to_string(here - most_inside_) +
               " requests of this kind are queued; send the request again later");
  const std::uint64_t number = came_++;
  changed_.wait(lock, [&] { return stopping_ || number < left_ + most_inside_; });
  if (stopping_)
    throw Error("shutting down: the request was not answered");
}

void Admission::leave()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  ++left_;
  changed_.notify_all();
}
}  // namespace gpu_planning_scene::core
