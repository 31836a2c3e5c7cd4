#include "node/shutdown_deadline.h"

#include <chrono>
#include <cstdlib>

#include <ros/console.h>

namespace gpu_planning_scene::core
{
ShutdownDeadline::ShutdownDeadline(double seconds)
  : thread_(
        [this, seconds]
        {
          std::unique_lock<std::mutex> lock(mutex_);
          if (wake_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return over_; }))
            return;
          ROS_FATAL_STREAM("the shutdown took longer than " << seconds << " s; the process exits now");
          std::_Exit(EXIT_FAILURE);
        })
{
}

ShutdownDeadline::~ShutdownDeadline()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  thread_.join();
}
}  // namespace gpu_planning_scene::core
