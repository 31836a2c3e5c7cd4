#pragma once

#include <functional>
#include <string>

#include <sensor_msgs/PointCloud2.h>

#include "gpu_planning_scene/point_cloud.h"
#include "node/sensors/measured_at.h"
#include "service/memory_guard.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Turns each point cloud into a world object, which replaces the object of the previous cloud. Not thread-safe.
class CloudTopic
{
 public:
  /// `find_frame`: see Sensors. `frame_timeout`: seconds that a cloud waits for its frame and for the robot's pose.
  /// `stopping`: when it returns true, the wait ends.
  CloudTopic(SceneStore& store, SceneStore::Lookup find_frame, double frame_timeout, std::function<bool()> stopping,
             const MemoryGuard& memory, const PointCloudOptions& options, std::string id);

  /// It may wait. If it throws Error, nothing has changed.
  void take(const sensor_msgs::PointCloud2& message);

 private:
  MeasuredAt waitFor(const std_msgs::Header& header) const;

  SceneStore& store_;
  const SceneStore::Lookup find_frame_;
  const double frame_timeout_;
  const std::function<bool()> stopping_;
  const MemoryGuard& memory_;
  const std::string id_;
  PointCloudFilter filter_;
};
}  // namespace gpu_planning_scene::core
