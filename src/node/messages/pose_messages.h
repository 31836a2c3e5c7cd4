#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Quaternion.h>
#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
inline geometry_msgs::Quaternion orientationOf(const Eigen::Isometry3d& pose)
{
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::Quaternion message;
  message.x = rotation.x();
  message.y = rotation.y();
  message.z = rotation.z();
  message.w = rotation.w();
  return message;
}

/// Sets a geometry_msgs/Point or Vector3.
template <class Position>
void setPosition(Position& message, const Eigen::Vector3d& position)
{
  message.x = position.x();
  message.y = position.y();
  message.z = position.z();
}

inline geometry_msgs::Point pointOf(const Eigen::Vector3d& point)
{
  geometry_msgs::Point message;
  setPosition(message, point);
  return message;
}

inline geometry_msgs::Pose poseOf(const Eigen::Isometry3d& pose)
{
  geometry_msgs::Pose message;
  setPosition(message.position, pose.translation());
  message.orientation = orientationOf(pose);
  return message;
}
}  // namespace gpu_planning_scene::core
