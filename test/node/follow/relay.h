#pragma once

#include <atomic>
#include <string>

#include <ros/ros.h>

#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// Passes on the scene of the leader under another name, and can lose differences.
class Relay
{
 public:
  Relay(const std::string& name, const std::string& leader);

  /// The next difference is lost.
  void loseNext() { loses_ = true; }
  bool hasLost() const { return !loses_; }
  bool hasSubscriber() const { return publisher_.getNumSubscribers() != 0; }
  /// How often a follower has fetched the whole scene.
  int fetches() const { return fetches_; }
  /// How often a follower has compared the revisions.
  int comparisons() const { return comparisons_; }

 private:
  void pass(const PlanningSceneMessage& message);
  bool answer(GetPlanningScene::Request& request, GetPlanningScene::Response& response);

  const std::string leader_;
  std::atomic<bool> loses_{false};
  std::atomic<int> fetches_{0};
  std::atomic<int> comparisons_{0};
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  ros::ServiceServer service_;
  ros::Subscriber subscriber_;
};
}  // namespace gpu_planning_scene::core
