#pragma once

#include <mutex>
#include <vector>

#include "node/endpoints/topic_warnings.h"
#include "node/moveit/moveit_kinematics.h"
#include "node/moveit/moveit_messages.h"
#include "node/moveit/state_validity.h"
#include "node/scene/scene_services.h"
#include "node/scene/scene_topics.h"

namespace gpu_planning_scene::core
{
/// Publishes the scene as move_group does, as moveit_msgs/PlanningScene on move_group/monitored_planning_scene: the
/// whole scene to each new subscriber, then each change. Changes of joint values are published at 2 Hz.
class MoveItScenePublisher
{
 public:
  MoveItScenePublisher(ros::NodeHandle& node, SceneStore& store);
  ~MoveItScenePublisher();

 private:
  void changed(const std::shared_ptr<const PlanningScene>& before, const std::shared_ptr<const PlanningScene>& after);
  void publishFull(const ros::SingleSubscriberPublisher& subscriber);
  void publishState();

  SceneStore& store_;
  std::mutex mutex_;  // keeps the messages in the order of their scenes
  std::vector<double> published_state_;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};

/// The services and topics of a move_group, with MoveIt's names and types in the namespace of the node, so that
/// MoveIt's clients can talk to the node where no move_group runs.
class MoveItNames
{
 public:
  /// Throws Error if another node has one of the services. All arguments must outlive this object.
  MoveItNames(ros::NodeHandle& node, SceneStore& store, SceneServices& changes, const ClearOctomap& clear_octomap,
              const StateValidity& validity, const MoveItKinematics& kinematics, const FrameLookup& lookup,
              Diagnostics& diagnostics, std::size_t max_changes, std::size_t max_bytes);
  ~MoveItNames() = default;
  MoveItNames(const MoveItNames&) = delete;
  MoveItNames& operator=(const MoveItNames&) = delete;

  void close();
  void stop();
  bool refuseWaiting();

 private:
  MoveItScenePublisher publisher_;
  OccasionalWarning mimic_warning_;
  Endpoints scenes_;
  Endpoints checks_;
  SceneTopics topics_;
};
}  // namespace gpu_planning_scene::core
