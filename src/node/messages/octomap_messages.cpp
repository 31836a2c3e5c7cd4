#include "node/messages/octomap_messages.h"

#include <limits>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "node/messages/object_from_message.h"
#include "node/messages/pose_messages.h"

namespace gpu_planning_scene::core
{
std::optional<ObjectChange> octomapChangeFrom(const OctomapWithPose& message, std::size_t max_leaves)
{
  const Octomap& octomap = message.octomap;
  if (octomap.id.empty())
  {
    if (!octomap.data.empty())
      throw Error("world.octomap has data, but octomap.id is empty; set it to OcTree or ColorOcTree");
    return std::nullopt;
  }
  ObjectChange change;
  change.id = kOctomapId;
  change.shapes = occupiedLeaves({octomap.id, octomap.binary != 0, octomap.resolution, octomap.data},
                                 max_leaves == 0 ? std::numeric_limits<std::size_t>::max() : max_leaves);
  if (change.shapes.empty())
  {
    change.operation = Operation::Remove;
    return change;
  }
  change.frame = {message.header.frame_id, static_cast<std::int64_t>(message.header.stamp.toNSec())};
  change.pose = isUnset(message.origin) ? Eigen::Isometry3d::Identity() : isometryOf(message.origin);
  return change;
}

OctomapWithPose octomapMessageOf(const ObjectChange& change, const std::string& planning_frame)
{
  OctomapWithPose message;
  message.header.frame_id = change.frame.name.empty() ? planning_frame : change.frame.name;
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(change.frame.stamp));
  message.origin = poseOf(change.pose.value_or(Eigen::Isometry3d::Identity()));
  message.octomap.header = message.header;
  if (change.operation == Operation::Remove)
  {
    message.octomap.id = "cleared";
    return message;
  }
  SerializedOctree octree = octreeOf(change.shapes);
  message.octomap.binary = 1;
  message.octomap.id = octree.id;
  message.octomap.resolution = octree.resolution;
  message.octomap.data = std::move(octree.bytes);
  return message;
}
}  // namespace gpu_planning_scene::core
