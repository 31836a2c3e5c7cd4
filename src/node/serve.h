#pragma once

#include <functional>
#include <memory>

#include <ros/node_handle.h>

#include "gpu_planning_scene/batch_checker.h"

namespace gpu_planning_scene
{
/// Makes the checker on the device that the options name; throws Error.
using OpenDevice = std::function<std::unique_ptr<StateChecker>(std::shared_ptr<const PlanningScene> scene,
                                                               const BatchCheckerOptions& options)>;

/// Serves a planning scene, as the node's parameters say, until `stop` is true or ROS shuts down. Then it answers what
/// runs, tells all that wait that it is shutting down, and returns. Throws Error where it cannot start.
void serve(ros::NodeHandle& node, ros::NodeHandle& own, const OpenDevice& open_device,
           const std::function<bool()>& stop);
}  // namespace gpu_planning_scene
