#pragma once

#include <sensor_msgs/JointState.h>

#include "node/frame_lookup.h"
#include "node/messages.h"
#include "service/memory_guard.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// Answers apply_planning_scene, get_planning_scene and clear, and makes what comes on topics. Thread-safe.
class SceneServices
{
 public:
  SceneServices(SceneStore& store, SceneStore::Lookup lookup, const MemoryGuard& memory);

  /// These throw nothing: what is wrong with a request is said in the response.
  ApplyPlanningScene::Response apply(const ApplyPlanningScene::Request& request);
  Clear::Response clear();
  GetPlanningScene::Response get(const GetPlanningScene::Request& request) const;

  /// What a message asks for. Throws Error; warnings are logged.
  SceneChange changeOf(const PlanningSceneMessage& message) const;
  SceneChange changeOf(const CollisionObject& message) const;
  SceneChange changeOf(const AttachedCollisionObject& message) const;
  /// Throws Error and has changed nothing; warnings are logged.
  void make(const SceneChange& change, const SceneStore::Lookup& lookup);

  /// Throws Error and has taken nothing. The names of other robots, and of joints without a variable, are passed over.
  void take(const sensor_msgs::JointState& message);

 private:
  SceneStore::Applied apply(const SceneChange& change, const SceneStore::Lookup& lookup);

  SceneStore& store_;
  const SceneStore::Lookup lookup_;
  const MemoryGuard& memory_;
};
}  // namespace gpu_planning_scene::core
