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

/// Initialised before any test. A test that reads it calls useMoveItResources() in this way.
inline const bool kUsesMoveItResources = (useMoveItResources(), true);

/// Lets pluginlib find the plugins of this build without a sourced workspace: adds this package and MoveIt's to
/// ROS_PACKAGE_PATH, and their libraries to CMAKE_PREFIX_PATH. `packages`: further folders of packages, each with a
/// colon behind it.
inline void useBuiltPlugins(const std::string& packages = "")
{
  const auto add = [](const char* variable, const std::string& folders)
  {
    const char* before = std::getenv(variable);
    setenv(variable, (folders + (before ? std::string(":") + before : "")).c_str(), 1);
  };
  add("ROS_PACKAGE_PATH", packages + GPS_SOURCE_DIR ":" GPS_MOVEIT_PREFIX "/share");
  add("CMAKE_PREFIX_PATH", GPS_DEVEL_PREFIX ":" GPS_MOVEIT_PREFIX);
  setenv("AMENT_PREFIX_PATH", "/usr", 0);  // Debian's pluginlib throws without it
}
}  // namespace gpu_planning_scene
