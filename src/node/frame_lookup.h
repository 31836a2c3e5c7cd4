#pragma once

#include <string>

#include <Eigen/Geometry>
#include <tf2_ros/transform_listener.h>

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene
{
/// Where frames of tf are in the planning frame. Thread-safe.
class FrameLookup
{
 public:
  FrameLookup(std::string planning_frame, double timeout);

  /// Waits for the frame at its stamp (0: the latest), but no longer than the timeout. Throws Error.
  Eigen::Isometry3d operator()(const FrameAt& frame) const;

 private:
  const std::string planning_frame_;
  const double timeout_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;  // with a thread of its own
};
}  // namespace gpu_planning_scene
