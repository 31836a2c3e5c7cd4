#include "client/call_watch.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::chrono::milliseconds kPeriod{100};  // between two looks at running calls
}  // namespace

CallWatch::CallWatch(double timeout)
  : timeout_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout))),
    thread_([this] { run(); })
{
}

CallWatch::~CallWatch()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

CallWatch::Guard::Guard(CallWatch& watch, const ros::ServiceClient& client) : watch_(watch)
{
  const std::lock_guard<std::mutex> lock(watch_.mutex_);
  call_ = watch_.calls_.insert(watch_.calls_.end(), {client, Clock::now() + watch_.timeout_});
  if (watch_.calls_.size() == 1)
    watch_.changed_.notify_one();
}

CallWatch::Guard::~Guard()
{
  const std::lock_guard<std::mutex> lock(watch_.mutex_);
  watch_.calls_.erase(call_);
}

void CallWatch::run()
{
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_)
  {
    if (calls_.empty())
    {
      changed_.wait(lock);
      continue;
    }
    for (Call& call : calls_)
      if (call.end <= Clock::now())
        call.client.shutdown();
    changed_.wait_for(lock, kPeriod);
  }
}
}  // namespace gpu_planning_scene::core
