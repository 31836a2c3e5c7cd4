#include "node/scene/scene_topics.h"

namespace gpu_planning_scene::core
{
SceneTopics::SceneTopics(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneServices& changes,
                         const FrameLookup& lookup, Diagnostics& diagnostics, std::size_t max_changes,
                         std::size_t max_bytes, Endpoints::Precondition precondition)
  : changes_(changes),
    lookup_(lookup),
    topics_(node, own, 1, diagnostics, std::move(precondition)),  // one thread, to keep the order of the messages
    queue_([this] { return beginBatch(); },
           [this](const std::string& topic, const std::string& why) { topics_.refuse(topic, why); }, max_changes,
           max_bytes)
{
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

void SceneTopics::subscribeToOwn()
{
  const auto change_of = [this](const auto& message) { return changes_.changeOf(message); };
  subscribe<PlanningSceneMessage>("~planning_scene", change_of);
  subscribe<CollisionObject>("~collision_object", change_of);
  subscribe<AttachedCollisionObject>("~attached_collision_object", change_of);
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
