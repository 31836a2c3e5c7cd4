#pragma once

#include <memory>
#include <unordered_map>

#include <geometry_msgs/Quaternion.h>
#include <shape_msgs/Mesh.h>
#include <trajectory_msgs/JointTrajectory.h>

#include "gpu_planning_scene/scene_change.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// The meshes of one message. Equal meshes become one object, so that they share one tree.
class InlineMeshes
{
 public:
  std::shared_ptr<const Mesh> meshOf(const shape_msgs::Mesh& message, const std::string& object);

 private:
  std::unordered_multimap<std::size_t, std::shared_ptr<const Mesh>> meshes_;  // by a hash of their vertices
};

ObjectChange objectChangeFrom(const CollisionObject& message, InlineMeshes& meshes);
AttachedChange attachedChangeFrom(const AttachedCollisionObject& message, InlineMeshes& meshes);

JointTrajectory postureFrom(const trajectory_msgs::JointTrajectory& message);

/// Returns true for a pose whose numbers are all 0. ROS fills a pose that was never set with zeros.
bool isUnset(const geometry_msgs::Pose& pose);

Eigen::Quaterniond rotationOf(const geometry_msgs::Quaternion& message);

/// The pose of a position (geometry_msgs/Point or Vector3) and an orientation. The orientation is normalised; the zero
/// quaternion means no rotation.
template <class Position>
Eigen::Isometry3d isometryOf(const Position& position, const geometry_msgs::Quaternion& orientation)
{
  return Eigen::Translation3d(position.x, position.y, position.z) * rotationOf(orientation);
}
inline Eigen::Isometry3d isometryOf(const geometry_msgs::Pose& pose)
{
  return isometryOf(pose.position, pose.orientation);
}
}  // namespace gpu_planning_scene::core
