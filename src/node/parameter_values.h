#pragma once

#include <cstddef>
#include <string>

#include <ros/node_handle.h>

namespace gpu_planning_scene::core
{
/// Each reads one parameter, `fallback` where it is not set, and throws Error, which names the parameter and the values
/// it may have, for one of the wrong type or out of range.

/// roslaunch makes an integer of a device index or of a name like "0": that is a text too.
std::string textParameter(const ros::NodeHandle& node, const std::string& name, const std::string& fallback);
/// Finite, and at least 0.
double lengthParameter(const ros::NodeHandle& node, const std::string& name, double fallback);
/// Finite, and above 0.
double positiveParameter(const ros::NodeHandle& node, const std::string& name, double fallback);
/// An integer within these bounds; a number like 1e6 is one.
std::size_t countParameter(const ros::NodeHandle& node, const std::string& name, std::size_t fallback,
                           std::size_t least, std::size_t most);

/// The full name of a parameter that lies in this namespace or one above it; under that name where there is none.
std::string searchedParameter(const ros::NodeHandle& node, const std::string& name);
}  // namespace gpu_planning_scene::core
