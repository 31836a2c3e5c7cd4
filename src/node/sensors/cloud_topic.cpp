#include "node/sensors/cloud_topic.h"

#include <chrono>
#include <thread>
#include <utility>

#include "base/seconds_since.h"
#include "gpu_planning_scene/error.h"
#include "node/messages/sensor_messages.h"
#include "node/sensors/sensed_object.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::chrono::milliseconds kNextTry{10};
}  // namespace

CloudTopic::CloudTopic(SceneStore& store, SceneStore::Lookup find_frame, double frame_timeout,
                       std::function<bool()> stopping, const MemoryGuard& memory, const PointCloudOptions& options,
                       std::string id)
  : store_(store),
    find_frame_(std::move(find_frame)),
    frame_timeout_(frame_timeout),
    stopping_(std::move(stopping)),
    memory_(memory),
    id_(std::move(id)),
    filter_(options)
{
}

MeasuredAt CloudTopic::waitFor(const std_msgs::Header& header) const
{
  const auto begin = std::chrono::steady_clock::now();
  for (;; std::this_thread::sleep_for(kNextTry))
    try
    {
      return measuredAt(header, store_, find_frame_);
    }
    catch (const NotKnownYet&)
    {
      if (stopping_() || secondsSince(begin) >= frame_timeout_)
        throw;
    }
}

void CloudTopic::take(const sensor_msgs::PointCloud2& message)
{
  memory_.require();
  const MeasuredAt measured = waitFor(message.header);
  WorldObject object =
      filter_.objectOf(id_, pointsOf(message), measured.sensor, *measured.now.scene, measured.state.data());
  replaceObject(store_, id_, std::move(object.shapes));
}
}  // namespace gpu_planning_scene::core
