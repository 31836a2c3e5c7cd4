#pragma once

#include "node/follow/scene_follower.h"

namespace gpu_planning_scene::core
{
/// How the node follows another node of this package: ~follow, ~follow_period and ~follow_timeout. `node` is empty if
/// it follows none. Throws Error, which names the parameter, for a wrong value and for values that exclude each other.
FollowOptions followOptionsFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own);
}  // namespace gpu_planning_scene::core
