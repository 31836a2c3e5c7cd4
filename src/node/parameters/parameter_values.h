#pragma once

#include <cstddef>
#include <string>

#include <ros/node_handle.h>

namespace gpu_planning_scene::core
{
// Each function reads one parameter and returns `fallback` if it is not set. For a value of the wrong type or out of
// range it throws Error, which names the parameter and its valid values.

/// Integers are accepted as texts, because roslaunch turns a text like "0" into an integer.
std::string textParameter(const ros::NodeHandle& node, const std::string& name, const std::string& fallback);
/// true or false.
bool flagParameter(const ros::NodeHandle& node, const std::string& name, bool fallback);
/// Finite, and at least 0.
double lengthParameter(const ros::NodeHandle& node, const std::string& name, double fallback);
/// Finite, and above 0.
double positiveParameter(const ros::NodeHandle& node, const std::string& name, double fallback);
/// An integer from `min` to `max`. A floating-point number without a fraction, such as 1e6, counts as an integer.
std::size_t countParameter(const ros::NodeHandle& node, const std::string& name, std::size_t fallback, std::size_t min,
                           std::size_t max);

/// The full name of a parameter in the handle's namespace or the nearest namespace above it. If no such parameter is
/// set, the name in the handle's namespace.
std::string searchedParameter(const ros::NodeHandle& node, const std::string& name);
}  // namespace gpu_planning_scene::core
