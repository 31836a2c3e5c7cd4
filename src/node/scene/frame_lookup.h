#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// Looks up poses of tf frames in the planning frame. Thread-safe.
class FrameLookup
{
 public:
  using Clock = std::chrono::steady_clock;  // not ROS time, which may stand still

  /// `timeout`: seconds. `stopping`: called from any thread; when it returns true, all waits end. `scene_frames`: names
  /// of the scene's frames, one of which the caller may have meant.
  FrameLookup(const std::string& planning_frame, double timeout, std::function<bool()> stopping,
              std::function<std::vector<std::string>()> scene_frames);

  /// The deadline of a lookup that starts now.
  Clock::time_point deadline() const;
  /// The pose of a frame, and the time in nanoseconds for which tf has it. The time is 0 if the frame never moves.
  struct Found
  {
    Eigen::Isometry3d pose;
    std::int64_t stamp;
  };
  /// The pose of the frame at its stamp (0: the latest). Does not wait. Throws tf2::TransformException.
  Found find(const StampedFrame& frame) const;
  /// The pose of the frame at its stamp (0: the latest). Waits for the frame, at most until `until`; then throws
  /// NotKnownYet, or Error if tf only has later transforms, or if the scene lacks the named subframe. The error says
  /// whether the name, the connection to the planning frame or the time is at fault.
  Eigen::Isometry3d operator()(const StampedFrame& frame, Clock::time_point until) const;
  /// The parent of a frame, the parent of its parent, and so on; empty for a frame that tf does not know.
  std::vector<std::string> parents(const std::string& frame) const;

 private:
  bool isTooOld(const StampedFrame& frame) const;
  bool isSubframeOfScene(const StampedFrame& frame) const;
  std::string fault(const std::string& frame, const ros::Time& stamp) const;

  const std::string planning_frame_;
  const double timeout_;
  const std::function<bool()> stopping_;
  const std::function<std::vector<std::string>()> scene_frames_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;  // has its own thread
};
}  // namespace gpu_planning_scene::core
