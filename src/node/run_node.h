#pragma once

#include "service/checker_maker.h"

namespace gpu_planning_scene::core
{
/// The main function of the node: connects to the ROS master, serves a planning scene until SIGINT, SIGTERM or ROS ends
/// it, and returns the exit status. Devices are opened by `open_device`.
int runNode(int argc, char** argv, const OpenDevice& open_device);
}  // namespace gpu_planning_scene::core
