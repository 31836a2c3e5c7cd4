#pragma once

#include "node/endpoints/endpoints.h"
#include "node/scene/frame_lookup.h"
#include "node/scene/scene_services.h"
#include "service/change_queue.h"

namespace gpu_planning_scene::core
{
/// Receives changes of the scene from topics, and makes them in the order of their arrival. No change is dropped
/// silently: a change above the bounds is logged as an error and counted with the rejected messages.
class SceneTopics
{
 public:
  /// The queue holds at most `max_changes` changes, from messages with `max_bytes` bytes in total. All arguments
  /// passed by reference must outlive this object.
  SceneTopics(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneServices& changes,
              const FrameLookup& lookup, Diagnostics& diagnostics, std::size_t max_changes, std::size_t max_bytes,
              Endpoints::Precondition precondition = {});
  /// Calls stop().
  ~SceneTopics();

  /// Subscribes to ~planning_scene, ~collision_object and ~attached_collision_object.
  void subscribeToOwn();
  /// Subscribes to a topic with the name of the node handle, or "~NAME". `change_of` converts a message to a change,
  /// and throws Error. roscpp's queue gets no bound (0), because it would drop the oldest messages silently. The thread
  /// of topics_ moves all messages to queue_, which has a bound.
  template <class Message, class ChangeOf>
  void subscribe(const std::string& name, ChangeOf change_of)
  {
    topics_.subscribe<Message>(
        name, 0,
        [this, name, change_of](const Message& message)
        {
          const std::size_t bytes = ros::serialization::serializationLength(message);
          queue_.add(topics_.topicName(name), change_of(message), bytes);
        });
  }

  /// Rejects all further messages.
  void close() { topics_.close(); }
  /// Calls close(), finishes the current change, and rejects the queued changes.
  void stop();

 private:
  ChangeQueue::ApplyChange beginBatch() const;

  SceneServices& changes_;
  const FrameLookup& lookup_;
  Endpoints topics_;
  ChangeQueue queue_;  // after topics_: its thread reports rejected changes to topics_
};
}  // namespace gpu_planning_scene::core
