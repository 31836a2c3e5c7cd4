#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// The value of ROS_PACKAGE_PATH, or the default of Debian's rospack.
std::string packagePathVariable();

/// Throws Error if the folder that the user has given for a package does not exist.
void requirePackageFolder(const std::string& folder, const std::string& package);
}  // namespace gpu_planning_scene::core
