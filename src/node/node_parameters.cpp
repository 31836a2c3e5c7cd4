#include "node/node_parameters.h"

#include <cmath>

#include <ros/package.h>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
namespace
{
using XmlRpc::XmlRpcValue;

/// Empty where it is not set. roslaunch makes an integer of a device index or of a name like "0".
std::string textParameter(const ros::NodeHandle& own, const std::string& name, const std::string& fallback)
{
  XmlRpcValue value;
  if (!own.getParam(name, value))
    return fallback;
  if (value.getType() == XmlRpcValue::TypeInt)
    return std::to_string(static_cast<int>(value));
  if (value.getType() != XmlRpcValue::TypeString)
    throw Error("parameter " + own.resolveName(name) + " is not a string");
  return static_cast<std::string>(value);
}

double numberParameter(const ros::NodeHandle& own, const std::string& name, double fallback)
{
  XmlRpcValue value;
  if (!own.getParam(name, value))
    return fallback;
  if (value.getType() == XmlRpcValue::TypeInt)
    return static_cast<int>(value);
  if (value.getType() != XmlRpcValue::TypeDouble)
    throw Error("parameter " + own.resolveName(name) + " is not a number");
  return static_cast<double>(value);
}

/// A parameter that lies in this namespace or one above it; under that name where there is none.
std::string searched(const ros::NodeHandle& node, const std::string& name)
{
  std::string found;
  return node.searchParam(name, found) ? found : node.resolveName(name);
}

void addFolder(const std::string& name, const std::string& folder, std::map<std::string, std::string>& folders)
{
  const std::size_t begin = folder.find_first_not_of(' ');
  if (name.empty() || begin == std::string::npos)
    throw Error("parameter ~packages: a package without a name or a folder");
  folders[name] = folder.substr(begin);
}

void addFolders(const XmlRpcValue& value, std::map<std::string, std::string>& folders)
{
  XmlRpcValue copy = value;  // XmlRpcValue has no const access
  if (copy.getType() == XmlRpcValue::TypeString)
  {
    const std::string text = static_cast<std::string>(copy);
    const std::size_t separator = text.find_first_of("=:");
    if (separator == std::string::npos)
      throw Error("parameter ~packages: '" + text + "' is not NAME=DIR");
    addFolder(text.substr(0, separator), text.substr(separator + 1), folders);
    return;
  }
  if (copy.getType() != XmlRpcValue::TypeStruct)
    throw Error("parameter ~packages is not a map of NAME: DIR");
  for (auto& entry : copy)
  {
    if (entry.second.getType() != XmlRpcValue::TypeString)
      throw Error("parameter ~packages: the folder of '" + entry.first + "' is not a string");
    addFolder(entry.first, static_cast<std::string>(entry.second), folders);
  }
}
}  // namespace

std::map<std::string, std::string> packageFolders(const XmlRpcValue& value)
{
  std::map<std::string, std::string> folders;
  XmlRpcValue copy = value;
  if (copy.getType() != XmlRpcValue::TypeArray)
  {
    addFolders(copy, folders);
    return folders;
  }
  for (int i = 0; i < copy.size(); ++i)
    addFolders(copy[i], folders);
  return folders;
}

std::shared_ptr<const PlanningScene> sceneFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own,
                                                         std::vector<std::string>* warnings)
{
  XmlRpcValue packages;
  std::map<std::string, std::string> folders;
  if (own.getParam("packages", packages))
    folders = packageFolders(packages);
  RobotModelOptions options;
  options.packages = [known = packageResolver(folders)](const std::string& package)
  {
    const std::string folder = known(package);
    return folder.empty() ? ros::package::getPath(package) : folder;
  };
  options.urdf_folder = textParameter(own, "urdf_folder", "");
  options.unbounded_translation = numberParameter(own, "unbounded_translation", options.unbounded_translation);
  if (!(options.unbounded_translation >= 0.0))
    throw Error("parameter " + own.resolveName("unbounded_translation") + " is negative");

  options.urdf_name = searched(node, "robot_description");
  options.srdf_name = searched(node, "robot_description_semantic");
  const std::string urdf = textParameter(node, options.urdf_name, "");
  if (urdf.empty())
    throw Error("parameter " + options.urdf_name + " is not set; load the robot's URDF there");
  const auto robot = RobotModel::fromXml(urdf, textParameter(node, options.srdf_name, ""), options, warnings);

  const std::string scene_file = textParameter(own, "scene", "");
  if (!scene_file.empty() && scene_file[0] != '/' && scene_file.find("://") == std::string::npos)
    throw Error("parameter " + own.resolveName("scene") + ": '" + scene_file +
                "' is neither an absolute path nor a package:// or file:// URI");
  PlanningScene scene = scene_file.empty() ? PlanningScene(robot)
                                           : loadSceneFile(resolveUri(scene_file, "", options.packages), robot,
                                                           options.packages, warnings);
  scene.revision = 1;
  return std::make_shared<const PlanningScene>(std::move(scene));
}

BatchCheckerOptions checkerOptionsFromParameters(const ros::NodeHandle& own)
{
  BatchCheckerOptions options;
  options.device = textParameter(own, "device", options.device);
  if (own.hasParam("traversal"))
    options.traversal = traversalFromName(textParameter(own, "traversal", ""));
  const double max_batch = numberParameter(own, "max_batch", static_cast<double>(options.max_batch));
  constexpr double kMost = 1 << 24;
  if (!(max_batch >= 1.0 && max_batch <= kMost) ||
      max_batch != static_cast<double>(static_cast<std::size_t>(max_batch)))
    throw Error("parameter " + own.resolveName("max_batch") + " is not an integer from 1 to " +
                std::to_string(static_cast<std::size_t>(kMost)));
  options.max_batch = static_cast<std::size_t>(max_batch);
  options.tolerance = numberParameter(own, "tolerance", options.tolerance);
  if (!(options.tolerance >= 0.0 && std::isfinite(options.tolerance)))
    throw Error("parameter " + own.resolveName("tolerance") +
                " is negative or not finite; give metres, or 0 for exact answers");
  return options;
}
}  // namespace gpu_planning_scene
