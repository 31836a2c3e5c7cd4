#include "node/parameters/padding_parameters.h"

#include <algorithm>

#include "gpu_planning_scene/error.h"
#include "node/parameters/parameter_values.h"
#include "scene/missing_link.h"

namespace gpu_planning_scene::core
{
namespace
{
using XmlRpc::XmlRpcValue;

/// Sets the values of the links in the parameter `name`.
void setOfLinks(const ros::NodeHandle& node, const std::string& name, const RobotModel& robot, bool may_be_zero,
                std::vector<double>& values, std::vector<std::string>* warnings)
{
  XmlRpcValue map;
  if (!node.getParam(name, map))
    return;
  if (map.getType() != XmlRpcValue::TypeStruct)
    throw Error("parameter " + node.resolveName(name) + " is not a map of LINK: VALUE");
  for (const auto& entry : map)
  {
    const std::string own = name + "/" + entry.first;
    const double value = may_be_zero ? lengthParameter(node, own, 0.0) : positiveParameter(node, own, 1.0);
    const int link = robot.linkIndex(entry.first);
    if (link >= 0)
      values[static_cast<std::size_t>(link)] = value;
    else if (warnings != nullptr)
      warnings->push_back("parameter " + node.resolveName(name) + ": the robot " + noLinkText(robot, entry.first));
  }
}

/// Returns no values if all links have the usual value, which needs no entries in SceneDefaults.
std::vector<double> orNone(std::vector<double> values, double usual)
{
  const bool all_usual = std::all_of(values.begin(), values.end(), [usual](double value) { return value == usual; });
  return all_usual ? std::vector<double>() : values;
}
}  // namespace

SceneDefaults defaultsFromParameters(const ros::NodeHandle& node, const std::string& description,
                                     const RobotModel& robot, std::vector<std::string>* warnings)
{
  const std::string folder = description + "_planning/";
  SceneDefaults defaults;
  std::vector<double> padding(robot.links().size(), lengthParameter(node, folder + "default_robot_padding", 0.0));
  std::vector<double> scale(robot.links().size(), positiveParameter(node, folder + "default_robot_scale", 1.0));
  setOfLinks(node, folder + "default_robot_link_padding", robot, true, padding, warnings);
  setOfLinks(node, folder + "default_robot_link_scale", robot, false, scale, warnings);
  defaults.link_padding = orNone(std::move(padding), 0.0);
  defaults.link_scale = orNone(std::move(scale), 1.0);
  defaults.object_padding = lengthParameter(node, folder + "default_object_padding", 0.0);
  defaults.attached_padding = lengthParameter(node, folder + "default_attached_padding", 0.0);
  return defaults;
}
}  // namespace gpu_planning_scene::core
