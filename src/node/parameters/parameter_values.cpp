#include "node/parameters/parameter_values.h"

#include <cmath>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using XmlRpc::XmlRpcValue;

double numberParameter(const ros::NodeHandle& node, const std::string& name, double fallback)
{
  XmlRpcValue value;
  if (!node.getParam(name, value))
    return fallback;
  if (value.getType() == XmlRpcValue::TypeInt)
    return static_cast<int>(value);
  if (value.getType() != XmlRpcValue::TypeDouble)
    throw Error("parameter " + node.resolveName(name) + " is not a number");
  return static_cast<double>(value);
}
}  // namespace

std::string textParameter(const ros::NodeHandle& node, const std::string& name, const std::string& fallback)
{
  XmlRpcValue value;
  if (!node.getParam(name, value))
    return fallback;
  if (value.getType() == XmlRpcValue::TypeInt)
    return std::to_string(static_cast<int>(value));
  if (value.getType() != XmlRpcValue::TypeString)
    throw Error("parameter " + node.resolveName(name) + " is not a string");
  return static_cast<std::string>(value);
}

bool flagParameter(const ros::NodeHandle& node, const std::string& name, bool fallback)
{
  XmlRpcValue value;
  if (!node.getParam(name, value))
    return fallback;
  if (value.getType() != XmlRpcValue::TypeBoolean)
    throw Error("parameter " + node.resolveName(name) + " is not true or false");
  return static_cast<bool>(value);
}

double lengthParameter(const ros::NodeHandle& node, const std::string& name, double fallback)
{
  const double value = numberParameter(node, name, fallback);
  if (!(value >= 0.0 && std::isfinite(value)))
    throw Error("parameter " + node.resolveName(name) + " is negative or not finite");
  return value;
}

double positiveParameter(const ros::NodeHandle& node, const std::string& name, double fallback)
{
  const double value = numberParameter(node, name, fallback);
  if (!(value > 0.0 && std::isfinite(value)))
    throw Error("parameter " + node.resolveName(name) + " is not above 0, or not finite");
  return value;
}

std::size_t countParameter(const ros::NodeHandle& node, const std::string& name, std::size_t fallback, std::size_t min,
                           std::size_t max)
{
  const double value = numberParameter(node, name, static_cast<double>(fallback));
  if (!(value >= static_cast<double>(min) && value <= static_cast<double>(max)) || value != std::floor(value))
    throw Error("parameter " + node.resolveName(name) + " is not an integer from " + std::to_string(min) + " to " +
                std::to_string(max));
  return static_cast<std::size_t>(value);
}

std::string searchedParameter(const ros::NodeHandle& node, const std::string& name)
{
  std::string found;
  return node.searchParam(name, found) ? found : node.resolveName(name);
}
}  // namespace gpu_planning_scene::core
