#pragma once

#include "node/follow/scene_follower.h"

namespace gpu_planning_scene::core
{
struct MoveItOptions
{
  /// How the node follows the scene of a move_group: ~monitor, ~monitor_service, ~monitor_period and ~monitor_timeout.
  /// `node` is empty if it follows none.
  FollowOptions monitor;
  bool names = false;  ///< whether the node has the services and topics of a move_group: ~moveit_names
};

/// Reads the parameters above. Throws Error, which names the parameter, for a wrong value and for values that exclude
/// each other.
MoveItOptions moveItOptionsFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own);
}  // namespace gpu_planning_scene::core
