#pragma once

#include <string>
#include <vector>

#include <sensor_msgs/PointCloud2.h>

#include "gpu_planning_scene/point_cloud.h"
#include "service/memory_guard.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// The points of a cloud, from its fields x, y and z of 32-bit floats. Throws Error: no such fields, or sizes that do
/// not fit together.
std::vector<Eigen::Vector3f> pointsOf(const sensor_msgs::PointCloud2& message);

/// Makes of each point cloud an object of the scene, which replaces the last one's. One caller at a time.
class CloudTopic
{
 public:
  CloudTopic(SceneStore& store, SceneStore::Lookup lookup, const MemoryGuard& memory, const PointCloudOptions& options,
             std::string id);

  /// Throws Error and has changed nothing.
  void take(const sensor_msgs::PointCloud2& message);

 private:
  SceneStore& store_;
  const SceneStore::Lookup lookup_;
  const MemoryGuard& memory_;
  const std::string id_;
  PointCloudFilter filter_;
};
}  // namespace gpu_planning_scene::core
