#pragma once

#include <chrono>
#include <functional>
#include <string>

#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// Where frames of tf are in the planning frame. Thread-safe.
class FrameLookup
{
 public:
  using Clock = std::chrono::steady_clock;  // ROS time may stand still

  /// Nobody waits any more once `stopping` is true; any thread asks it.
  FrameLookup(std::string planning_frame, double timeout, std::function<bool()> stopping);

  /// Until when who asks now has to wait.
  Clock::time_point deadline() const;
  /// Waits for the frame at its stamp (0: the latest), but no longer than that. Throws Error.
  Eigen::Isometry3d operator()(const FrameAt& frame, Clock::time_point until) const;

 private:
  const std::string planning_frame_;
  const double timeout_;
  const std::function<bool()> stopping_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;  // with a thread of its own
};
}  // namespace gpu_planning_scene::core
