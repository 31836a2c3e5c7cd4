#pragma once

#include <atomic>
#include <memory>

namespace gpu_planning_scene::core
{
/// Listens for what `rosnode kill`, and the master where another node of this name starts, ask for: an end. roscpp
/// would shut down at once, and drop the requests that are being answered; as long as this lives it is told instead.
class ShutdownCall
{
 public:
  /// ROS has started.
  ShutdownCall();
  ~ShutdownCall();
  ShutdownCall(const ShutdownCall&) = delete;
  ShutdownCall& operator=(const ShutdownCall&) = delete;

  bool came() const { return *came_; }

 private:
  const std::shared_ptr<std::atomic<bool>> came_;  // the call may outlive this
};
}  // namespace gpu_planning_scene::core
