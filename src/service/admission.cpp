#include "service/admission.h"

#include <string>

#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
void Admission::stop()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
}

/// Callers are numbered and admitted in the order of their arrival: number n is admitted when n < departed_ +
/// max_inside_.
void Admission::enter()
{
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t here = arrived_ - departed_;
  if (!stopping_ && here >= max_inside_ + max_waiting_)
    throw Busy("busy: " + std::to_string(here - max_inside_) +
               " requests of this kind are queued; send the request again later");
  const std::uint64_t number = arrived_++;
  changed_.wait(lock, [&] { return stopping_ || number < departed_ + max_inside_; });
  if (stopping_)
    throw ShuttingDown();
}

void Admission::leave()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  ++departed_;
  changed_.notify_all();
}
}  // namespace gpu_planning_scene::core
