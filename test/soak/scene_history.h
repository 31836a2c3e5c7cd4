#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>

#include <ros/ros.h>

#include "gpu_planning_scene/planning_scene.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// The scenes of a node, one for each revision, reconstructed from the differences that the node publishes.
class SceneHistory
{
 public:
  /// `max_scenes`: number of scenes that are kept.
  explicit SceneHistory(std::shared_ptr<const RobotModel> robot, std::size_t max_scenes = 20000);

  /// Starts the history with `scene`, the node's current scene with the fields for followers. Call it once, after
  /// listens() is true.
  void start(const PlanningSceneMessage& scene);
  bool listens() const { return subscriber_.getNumPublishers() != 0; }
  /// Waits up to 10 s for the scene; null if the revision is unknown. Old scenes are removed.
  std::shared_ptr<const PlanningScene> at(std::uint64_t revision);
  /// Number of differences that did not follow the last known scene.
  int gaps() const;

 private:
  void take(const PlanningSceneMessage& message);
  void follow(const PlanningSceneMessage& message);

  std::shared_ptr<const RobotModel> robot_;
  const std::size_t max_scenes_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint64_t, std::shared_ptr<const PlanningScene>> scenes_;
  std::vector<PlanningSceneMessage> early_;
  int gaps_ = 0;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
};
}  // namespace gpu_planning_scene::core
