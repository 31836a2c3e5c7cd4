#include "node/scene/scene_topics.h"

namespace gpu_planning_scene::core
{
SceneTopics::SceneTopics(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneServices& changes,
                         const FrameLookup& lookup, Diagnostics& diagnostics, std::size_t max_changes,
                         std::size_t max_bytes)
  : changes_(changes),
    lookup_(lookup),
    topics_(node, own, 1, diagnostics),  // one thread, to keep the order of the messages
    queue_([this] { return beginBatch(); },
           [this](const std::string& topic, const std::string& why) { topics_.refuse(topic, why); }, max_changes,
           max_bytes)
{
  subscribe<PlanningSceneMessage>(own, "planning_scene");
  subscribe<CollisionObject>(own, "collision_object");
  subscribe<AttachedCollisionObject>(own, "attached_collision_object");
}

SceneTopics::~SceneTopics()
{
  stop();
}

void SceneTopics::stop()
{
  topics_.close();
  queue_.stop();
  topics_.stop();
}

/// roscpp's queue gets no bound (0), because it would drop the oldest messages silently. The thread of topics_ moves
/// all messages to queue_, which has a bound.
template <class Message>
void SceneTopics::subscribe(const ros::NodeHandle& own, const std::string& name)
{
  topics_.subscribe<Message>(
      "~" + name, 0,
      [this, topic = own.resolveName(name)](const Message& message)
      {
        const std::size_t bytes = ros::serialization::serializationLength(message);
        queue_.add(topic, changes_.changeOf(message), bytes);
      });
}

/// Returns the function that makes the changes of one set. They share a deadline for frames: while one change waits for
/// its frame, the others wait as well.
ChangeQueue::ApplyChange SceneTopics::beginBatch() const
{
  const auto until = lookup_.deadline();
  return [this, until](const SceneChange& change)
  { changes_.make(change, [this, until](const StampedFrame& frame) { return lookup_(frame, until); }); };
}
}  // namespace gpu_planning_scene::core
