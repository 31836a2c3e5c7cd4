#pragma once

#include <string>

#include <sensor_msgs/PointCloud2.h>

#include "gpu_planning_scene/point_cloud.h"
#include "service/memory_guard.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Turns each point cloud into a world object, which replaces the object of the previous cloud. Not thread-safe.
class CloudTopic
{
 public:
  CloudTopic(SceneStore& store, SceneStore::Lookup lookup, const MemoryGuard& memory, const PointCloudOptions& options,
             std::string id);

  /// If it throws Error, nothing has changed.
  void take(const sensor_msgs::PointCloud2& message);

 private:
  SceneStore& store_;
  const SceneStore::Lookup lookup_;
  const MemoryGuard& memory_;
  const std::string id_;
  PointCloudFilter filter_;
};
}  // namespace gpu_planning_scene::core
