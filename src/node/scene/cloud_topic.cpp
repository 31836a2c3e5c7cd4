#include "node/scene/cloud_topic.h"

#include <algorithm>
#include <cstring>

#include "gpu_planning_scene/error.h"
#include "node/endpoints/topic_warnings.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Offset of the field in a point, in bytes.
std::size_t offsetOf(const sensor_msgs::PointCloud2& message, const std::string& name)
{
  for (const sensor_msgs::PointField& field : message.fields)
    if (field.name == name && field.datatype == sensor_msgs::PointField::FLOAT32 &&
        std::size_t{field.offset} + sizeof(float) <= message.point_step)
      return field.offset;
  throw Error("the point cloud has no FLOAT32 field '" + name + "' inside point_step");
}
}  // namespace

std::vector<Eigen::Vector3f> pointsOf(const sensor_msgs::PointCloud2& message)
{
  if (message.is_bigendian)
    throw Error("the point cloud has big-endian numbers; send little-endian numbers");
  const std::array<std::size_t, 3> offsets = {{offsetOf(message, "x"), offsetOf(message, "y"), offsetOf(message, "z")}};
  const std::uint64_t row = std::uint64_t{message.width} * message.point_step;
  if (message.row_step < row || message.data.size() < std::uint64_t{message.height} * message.row_step)
    throw Error("the data of the point cloud (" + std::to_string(message.data.size()) +
                " bytes) is too short for its " + std::to_string(message.height) + " rows of " +
                std::to_string(message.width) + " points");
  std::vector<Eigen::Vector3f> points;
  if (row == 0)
    return points;  // without a loop over `height`, which may be any number here
  points.reserve(std::size_t{message.width} * message.height);
  for (std::size_t y = 0; y < message.height; ++y)
    for (std::size_t x = 0; x < message.width; ++x)
    {
      const std::uint8_t* at = message.data.data() + y * message.row_step + x * message.point_step;
      Eigen::Vector3f& point = points.emplace_back();
      for (int i = 0; i < 3; ++i)
        std::memcpy(&point[i], at + offsets[static_cast<std::size_t>(i)], sizeof(float));
    }
  return points;
}

CloudTopic::CloudTopic(SceneStore& store, SceneStore::Lookup lookup, const MemoryGuard& memory,
                       const PointCloudOptions& options, std::string id)
  : store_(store), lookup_(std::move(lookup)), memory_(memory), id_(std::move(id)), filter_(options)
{
}

void CloudTopic::take(const sensor_msgs::PointCloud2& message)
{
  memory_.require();
  const Snapshot now = store_.snapshot();
  if (!now.allKnown())
    throw Error(
        "the robot's state is not known yet, so points on the robot cannot be removed; publish joint_states first");
  const StampedFrame frame{message.header.frame_id, static_cast<std::int64_t>(message.header.stamp.toNSec())};
  const std::vector<double> state = store_.stateAt(frame.stamp);
  const std::optional<Eigen::Isometry3d> known = now.scene->frame(frame.name, state.data());
  const Eigen::Isometry3d sensor = known ? *known : lookup_(frame);
  WorldObject object = filter_.objectOf(id_, pointsOf(message), sensor, *now.scene, state.data());

  ObjectChange change;
  change.id = id_;
  change.pose = object.pose;
  change.shapes = std::move(object.shapes);
  if (change.shapes.empty())
  {
    const bool is_there = std::any_of(now.scene->objects.begin(), now.scene->objects.end(),
                                      [this](const WorldObject& other) { return other.id == id_; });
    if (!is_there)
      return;
    change.operation = Operation::Remove;
    change.keeps_allowed_collisions = true;  // for the next cloud, which has the same id
  }
  SceneChange diff;
  diff.is_diff = true;
  diff.objects.push_back(std::move(change));
  warnOfMessage(store_.apply(diff, lookup_).warnings);
}
}  // namespace gpu_planning_scene::core
