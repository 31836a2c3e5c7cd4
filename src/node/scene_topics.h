#pragma once

#include "node/endpoints.h"
#include "node/frame_lookup.h"
#include "node/scene_services.h"
#include "service/change_queue.h"

namespace gpu_planning_scene::core
{
/// Takes changes of the scene from the topics ~planning_scene, ~collision_object and ~attached_collision_object, and
/// makes them in the order in which they come. None is dropped without a word: over the bounds an error is logged, and
/// it is counted with all others that are refused.
class SceneTopics
{
 public:
  /// At most so many changes, and bytes of messages, wait. What is referred to outlives it.
  SceneTopics(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneServices& changes,
              const FrameLookup& lookup, Diagnostics& diagnostics, std::size_t most_changes, std::size_t most_bytes);
  /// As stop().
  ~SceneTopics();

  /// From now on, takes nothing.
  void close() { topics_.close(); }
  /// Closes, makes what it is making, and refuses what waits.
  void stop();

 private:
  template <class Message>
  void subscribe(const ros::NodeHandle& own, const std::string& name);
  ChangeQueue::Make maker() const;

  SceneServices& changes_;
  const FrameLookup& lookup_;
  Endpoints topics_;
  ChangeQueue queue_;  // its thread tells topics_ what is refused
};
}  // namespace gpu_planning_scene::core
