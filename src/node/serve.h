#pragma once

#include <functional>

#include <ros/node_handle.h>

#include "service/checker_maker.h"

namespace gpu_planning_scene::core
{
/// Serves a planning scene, as set by the node's parameters, until `stop` returns true or ROS shuts down. Then it
/// answers running small requests, rejects all others with the status SHUTTING_DOWN, and returns. Throws Error if it
/// cannot start.
void serve(ros::NodeHandle& node, ros::NodeHandle& own, const OpenDevice& open_device,
           const std::function<bool()>& stop);
}  // namespace gpu_planning_scene::core
