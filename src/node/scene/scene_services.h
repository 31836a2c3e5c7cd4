#pragma once

#include <functional>

#include <sensor_msgs/JointState.h>

#include "node/endpoints/topic_warnings.h"
#include "node/messages/messages.h"
#include "node/scene/frame_lookup.h"
#include "service/memory_guard.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Removes the octomap from the scene. Throws nothing: the response has the error.
using ClearOctomap = std::function<Clear::Response()>;

/// Answers apply_planning_scene, get_planning_scene, clear and clear_octomap, and makes the changes from topics.
/// Thread-safe.
class SceneServices
{
 public:
  /// `setup`: for messages to followers, see setupFromParameters.
  SceneServices(SceneStore& store, SceneStore::Lookup lookup, const MemoryGuard& memory, std::uint64_t setup = 0);

  /// These throw nothing: the response has the error.
  ApplyPlanningScene::Response apply(const ApplyPlanningScene::Request& request);
  Clear::Response clear();
  /// For a node without sensors. Its entries in the allowed collision matrix stay.
  Clear::Response clearOctomap();
  GetPlanningScene::Response get(const GetPlanningScene::Request& request) const;

  /// Converts a message to a change. Throws Error; warnings are logged.
  SceneChange changeOf(const PlanningSceneMessage& message) const;
  SceneChange changeOf(const CollisionObject& message) const;
  SceneChange changeOf(const AttachedCollisionObject& message) const;
  /// As in MoveIt, the message replaces all objects of the world and the octomap. The allowed collision matrix keeps
  /// their entries.
  SceneChange changeOf(const PlanningSceneWorld& message) const;
  /// Makes the change. If it throws Error, nothing has changed. Warnings are logged.
  void make(const SceneChange& change, const SceneStore::Lookup& lookup);
  /// Makes a change of a followed node, which has warned already. If it throws Error, nothing has changed.
  void follow(const SceneChange& change, std::uint64_t revision);

  /// Sets the robot's state. If it throws Error, nothing has changed. Names that are no variable of the robot are
  /// ignored.
  void take(const sensor_msgs::JointState& message);

 private:
  SceneStore::Applied apply(const SceneChange& change, const SceneStore::Lookup& lookup);

  SceneStore& store_;
  const SceneStore::Lookup lookup_;
  const MemoryGuard& memory_;
  const std::uint64_t setup_;
  OccasionalWarning joint_warning_;
  OccasionalWarning name_warning_;
  OccasionalWarning time_warning_;
};
}  // namespace gpu_planning_scene::core
