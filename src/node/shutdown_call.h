#pragma once

#include <atomic>
#include <memory>

namespace gpu_planning_scene::core
{
/// Receives the shutdown call of the ROS slave API during its lifetime. `rosnode kill` makes this call, and so does the
/// master when another node with this name starts. roscpp itself would shut down immediately, and drop the requests
/// that are being answered.
class ShutdownCall
{
 public:
  /// ROS must have been started.
  ShutdownCall();
  ~ShutdownCall();
  ShutdownCall(const ShutdownCall&) = delete;
  ShutdownCall& operator=(const ShutdownCall&) = delete;

  bool came() const { return *came_; }

 private:
  const std::shared_ptr<std::atomic<bool>> came_;  // shared, because a call may outlive this object
};
}  // namespace gpu_planning_scene::core
