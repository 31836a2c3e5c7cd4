#pragma once

#include <set>
#include <string>

#include "node/follow/scene_follower.h"
#include "node/moveit/moveit_messages.h"
#include "node/scene/scene_services.h"

namespace gpu_planning_scene::core
{
/// The parts of a scene that a change names, in words, for example "object 'box'". The values of joints are left out.
std::set<std::string> partsOf(const SceneChange& change);

/// Keeps the node's scene equal to the scene of a running move_group. It fetches the whole scene with MoveIt's service
/// get_planning_scene, and then applies the messages of monitored_planning_scene. MoveIt numbers neither messages nor
/// scenes. So the whole scene is also fetched anew periodically. If a periodic fetch brings a change that no message
/// brings until the next fetch, a message was missed, and there is a warning. Values of joints that the topic
/// joint_states has brought are kept.
class FollowedScene : private SceneFollower<MoveItScene, MoveItGetScene>
{
 public:
  /// `timers`: the node handle for a timer. All arguments passed by reference must outlive this object.
  FollowedScene(const ros::NodeHandle& node, ros::NodeHandle& timers, const FollowOptions& options, SceneStore& store,
                SceneServices& changes, SceneStore::Lookup lookup);
  /// Calls stop().
  ~FollowedScene() override;

  using SceneFollower::fault;
  using SceneFollower::requireScene;
  using SceneFollower::stop;

 private:
  MoveItGetScene::Request request() override;
  void take(const MoveItGetScene::Response& answer) override;
  void apply(const MoveItScene& message) override;
  void report(const std::set<std::string>& differences);
  SceneChange changeOf(const PlanningSceneMessage& message);

  SceneStore& store_;
  SceneServices& changes_;
  const SceneStore::Lookup lookup_;
  // Used by the thread only.
  std::set<std::string> unconfirmed_;  // parts that the last fetch changed, and that no message has named since
  OccasionalWarning mimic_warning_;
};
}  // namespace gpu_planning_scene::core
