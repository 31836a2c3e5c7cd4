#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>

#include <ros/ros.h>

#include "gpu_planning_scene/planning_scene.h"
#include "node/messages.h"

namespace gpu_planning_scene::core
{
/// The scenes that a node has had, one for each revision, made again from the differences that it publishes.
class SceneHistory
{
 public:
  explicit SceneHistory(std::shared_ptr<const RobotModel> robot);

  /// From here on: `scene` is what the node has. To be called once, after the node was found to publish.
  void start(const PlanningSceneMessage& scene);
  bool listens() const { return subscriber_.getNumPublishers() != 0; }
  /// Waits for it a while; null where it does not come. Old scenes are forgotten.
  std::shared_ptr<const PlanningScene> at(std::uint64_t revision);
  /// How often a difference did not follow the scene before it.
  int gaps() const;

 private:
  void take(const PlanningSceneMessage& message);
  void follow(const PlanningSceneMessage& message);

  std::shared_ptr<const RobotModel> robot_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint64_t, std::shared_ptr<const PlanningScene>> scenes_;
  std::vector<PlanningSceneMessage> early_;
  int gaps_ = 0;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
};
}  // namespace gpu_planning_scene::core
