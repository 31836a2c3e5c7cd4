#pragma once

#include <mutex>
#include <string>

#include "node/follow/scene_follower.h"
#include "node/messages/messages.h"
#include "node/scene/scene_services.h"

namespace gpu_planning_scene::core
{
/// Keeps the node's scene and its revision equal to those of another planning_scene_node, the leader. It fetches the
/// whole scene once, and then makes the leader's changes. A change that does not begin at the node's revision shows
/// that one is missing. The whole scene is then fetched anew. It is also fetched anew after the leader or a connection
/// to it has ended. If the last change is missing, no later change shows it, so the revisions are also compared from
/// time to time. Values of joints that the topic joint_states has brought are kept.
class LeaderScene : private SceneFollower<PlanningSceneMessage, GetPlanningScene>
{
 public:
  /// `setup`: of this node, see setupFromParameters. All arguments passed by reference must outlive this object.
  LeaderScene(const ros::NodeHandle& node, ros::NodeHandle& timers, const FollowOptions& options, std::uint64_t setup,
              SceneStore& store, SceneServices& changes);
  /// Calls stop().
  ~LeaderScene() override;

  using SceneFollower::fault;
  using SceneFollower::requireScene;
  using SceneFollower::stop;
  /// The reason why the node's clients cannot change the scene.
  std::string changeFault() const;

 private:
  GetPlanningScene::Request request() override;
  void take(const GetPlanningScene::Response& answer) override;
  void apply(const PlanningSceneMessage& message) override;
  SceneChange changeOf(const PlanningSceneMessage& message) const;
  void takeWhole(const PlanningSceneMessage& whole);
  void takeOctomapFault(const PlanningSceneMessage& message);

  const std::uint64_t setup_;
  SceneStore& store_;
  SceneServices& changes_;
  std::uint64_t leader_revision_ = 0;  // at the last comparison; used by the thread only
  std::mutex octomap_mutex_;           // guards the next member
  std::string octomap_fault_;          // of the leader
};
}  // namespace gpu_planning_scene::core
