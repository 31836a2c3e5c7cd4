#pragma once

#include <cstdlib>
#include <string>

namespace gpu_planning_scene
{
/// MoveIt's loadTestingRobotModel() finds robots by ROS_PACKAGE_PATH. Adds the folder with MoveIt's test robots.
inline void useMoveItResources()
{
  const char* before = std::getenv("ROS_PACKAGE_PATH");
  const std::string path = std::string(GPS_MOVEIT_RESOURCES) + (before ? std::string(":") + before : "");
  setenv("ROS_PACKAGE_PATH", path.c_str(), 1);
}
}  // namespace gpu_planning_scene
