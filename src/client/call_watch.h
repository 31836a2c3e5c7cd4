#pragma once

#include <chrono>
#include <condition_variable>
#include <list>
#include <mutex>
#include <thread>

#include <ros/service_client.h>

namespace gpu_planning_scene::core
{
/// Ends service calls that take too long, by closing their connections: roscpp waits for an answer without a limit.
/// Thread-safe.
class CallWatch
{
  using Clock = std::chrono::steady_clock;
  struct Call
  {
    ros::ServiceClient client;
    Clock::time_point end;
  };

 public:
  explicit CallWatch(double timeout);  ///< seconds
  ~CallWatch();

  /// The call that runs during the lifetime of this object is ended after the timeout.
  class Guard
  {
   public:
    Guard(CallWatch& watch, const ros::ServiceClient& client);
    ~Guard();
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;

   private:
    CallWatch& watch_;
    std::list<Call>::iterator call_;
  };

 private:
  void run();

  const Clock::duration timeout_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::list<Call> calls_;
  bool stopping_ = false;
  std::thread thread_;
};
}  // namespace gpu_planning_scene::core
