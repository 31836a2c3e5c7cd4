#pragma once

#include <memory>
#include <mutex>

#include <ros/node_handle.h>

#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Publishes the scene. ~monitored_planning_scene_diffs gets each change. ~monitored_planning_scene gets the whole
/// scene: after each change that cannot be sent as a difference, and every `full_scene_period` seconds if the scene has
/// changed. A new subscriber of it gets the newest scene immediately. A difference names the revision before it, so
/// that a client notices a missing one and requests the whole scene. It has all known joint values, and the fields for
/// followers.
class ScenePublisher
{
 public:
  /// `setup`: for followers, see setupFromParameters.
  ScenePublisher(ros::NodeHandle& own, SceneStore& store, double full_scene_period, std::uint64_t setup);
  ~ScenePublisher();

 private:
  void changed(const std::shared_ptr<const PlanningScene>& before, const std::shared_ptr<const PlanningScene>& after);
  void publishFull(const Snapshot& now);
  void sendTo(const ros::SingleSubscriberPublisher& subscriber);

  SceneStore& store_;
  const std::uint64_t setup_;
  ros::Publisher diffs_;
  std::mutex mutex_;  // keeps the full scenes in the order of their revisions
  std::uint64_t full_revision_;
  // These two come last, because their callbacks use the other members.
  ros::Publisher full_;
  ros::WallTimer timer_;
};
}  // namespace gpu_planning_scene::core
