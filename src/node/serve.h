#pragma once

#include <functional>

#include <ros/node_handle.h>

#include "node/checker_maker.h"

namespace gpu_planning_scene::core
{
/// Serves a planning scene, as the node's parameters say, until `stop` is true or ROS shuts down. Then it answers what
/// runs, tells all that wait that it is shutting down, and returns. Throws Error where it cannot start.
void serve(ros::NodeHandle& node, ros::NodeHandle& own, const OpenDevice& open_device,
           const std::function<bool()>& stop);
}  // namespace gpu_planning_scene::core
