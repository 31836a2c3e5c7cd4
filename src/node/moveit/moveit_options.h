#pragma once

#include <string>

#include <ros/node_handle.h>

namespace gpu_planning_scene::core
{
/// How the node follows the scene of a move_group.
struct MonitorOptions
{
  std::string monitor;   ///< the full name of the move_group; empty: none is followed: ~monitor
  std::string service;   ///< the full name of its service get_planning_scene: ~monitor_service
  double period = 5.0;   ///< seconds between two fetches of the whole scene: ~monitor_period
  double timeout = 5.0;  ///< seconds: longest wait for the whole scene: ~monitor_timeout

  std::string topic() const { return monitor + "/monitored_planning_scene"; }
};

struct MoveItOptions
{
  MonitorOptions monitor;
  bool names = false;  ///< whether the node has the services and topics of a move_group: ~moveit_names
};

/// Reads the parameters above. Throws Error, which names the parameter, for a wrong value and for values that exclude
/// each other.
MoveItOptions moveItOptionsFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own);
}  // namespace gpu_planning_scene::core
