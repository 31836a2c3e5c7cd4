#pragma once

#include <string>

#include "node/follow/scene_link.h"
#include "node/messages/messages.h"
#include "node/scene/scene_services.h"

namespace gpu_planning_scene::core
{
/// Keeps the node's scene and its revision equal to those of another planning_scene_node, the leader. It fetches the
/// whole scene once, and then makes the leader's changes. A change that does not begin at the node's revision shows
/// that one is missing, and then the whole scene is fetched anew. So it is after the leader or a connection to it has
/// ended. The last change before a pause can be missing too. So the revisions are compared periodically. Values of
/// joints that the topic joint_states has brought are kept.
class LeaderScene : private SceneLink<PlanningSceneMessage, GetPlanningScene>
{
 public:
  /// `setup`: of this node, see setupFromParameters. All arguments passed by reference must outlive this object.
  LeaderScene(const ros::NodeHandle& node, ros::NodeHandle& timers, const LinkOptions& options, std::uint64_t setup,
              SceneStore& store, SceneServices& changes);
  /// Calls stop().
  ~LeaderScene() override;

  using SceneLink::fault;
  using SceneLink::stop;
  /// The reason why the node's clients cannot change the scene.
  std::string changeFault() const;

 private:
  GetPlanningScene::Request request() override;
  void take(const GetPlanningScene::Response& answer) override;
  void apply(const PlanningSceneMessage& message) override;
  SceneChange changeOf(const PlanningSceneMessage& message) const;
  void takeWhole(const PlanningSceneMessage& whole);

  const std::uint64_t setup_;
  SceneStore& store_;
  SceneServices& changes_;
  std::uint64_t leader_revision_ = 0;  // at the last comparison; used by the thread only
};
}  // namespace gpu_planning_scene::core
