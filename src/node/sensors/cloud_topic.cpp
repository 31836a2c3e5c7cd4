#include "node/sensors/cloud_topic.h"

#include "node/messages/sensor_messages.h"
#include "node/sensors/measured_at.h"
#include "node/sensors/sensed_object.h"

namespace gpu_planning_scene::core
{
CloudTopic::CloudTopic(SceneStore& store, SceneStore::Lookup lookup, const MemoryGuard& memory,
                       const PointCloudOptions& options, std::string id)
  : store_(store), lookup_(std::move(lookup)), memory_(memory), id_(std::move(id)), filter_(options)
{
}

void CloudTopic::take(const sensor_msgs::PointCloud2& message)
{
  memory_.require();
  const MeasuredAt measured = measuredAt(message.header, store_, lookup_);
  WorldObject object =
      filter_.objectOf(id_, pointsOf(message), measured.sensor, *measured.now.scene, measured.state.data());
  replaceObject(store_, id_, std::move(object.shapes));
}
}  // namespace gpu_planning_scene::core
