#pragma once

#include <memory>
#include <mutex>

#include <ros/node_handle.h>

#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Publishes the scene: ~monitored_planning_scene_diffs gets each change, ~monitored_planning_scene (latched) the whole
/// scene at the start, after each change that is no difference, and every few seconds where it has changed. A diff
/// names the revision that it follows: a client to which one is missing asks for the whole scene.
class ScenePublisher
{
 public:
  ScenePublisher(ros::NodeHandle& own, SceneStore& store, double full_scene_period);
  ~ScenePublisher();

 private:
  void changed(const std::shared_ptr<const PlanningScene>& before, const std::shared_ptr<const PlanningScene>& after);
  void publishFull(const Snapshot& now);

  SceneStore& store_;
  ros::Publisher full_;
  ros::Publisher diffs_;
  ros::WallTimer timer_;
  std::mutex mutex_;  // of the full scenes' order
  std::uint64_t full_revision_ = 0;
};
}  // namespace gpu_planning_scene::core
