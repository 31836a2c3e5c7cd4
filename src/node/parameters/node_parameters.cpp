#include "node/parameters/node_parameters.h"

#include <chrono>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "node/parameters/collision_operations.h"
#include "node/parameters/joint_limits_parameter.h"
#include "node/parameters/padding_parameters.h"
#include "node/parameters/parameter_values.h"

namespace gpu_planning_scene::core
{
namespace
{
using XmlRpc::XmlRpcValue;

constexpr std::size_t kNoLimit = 1000000000;

/// The node reads meshes in a separate process, and only from packages and from the folders of ~mesh/roots.
MeshAccess meshAccessFromParameters(const ros::NodeHandle& own)
{
  MeshLimits limits;
  limits.seconds = positiveParameter(own, "mesh/seconds", limits.seconds);
  limits.memory = countParameter(own, "mesh/memory", limits.memory, 1, std::size_t{1} << 52);
  limits.file = countParameter(own, "mesh/file_size", limits.file, 1, std::size_t{1} << 52);
  limits.triangles = countParameter(own, "limits/triangles_of_mesh", limits.triangles, 1, kNoLimit);
  MeshAccess access;
  access.read = childMeshReader(meshReaderProgram(), limits);
  AllowedRoots allowed;
  XmlRpcValue roots;
  if (own.getParam("mesh/roots", roots))
  {
    if (roots.getType() != XmlRpcValue::TypeArray)
      throw Error("parameter " + own.resolveName("mesh/roots") + " is not a list of folders");
    for (int i = 0; i < roots.size(); ++i)
    {
      if (roots[i].getType() != XmlRpcValue::TypeString)
        throw Error("parameter " + own.resolveName("mesh/roots") + " is not a list of folders");
      allowed.roots.push_back(static_cast<std::string>(roots[i]));
    }
  }
  access.roots = std::move(allowed);
  return access;
}

void addFolder(const std::string& name, const std::string& folder, std::map<std::string, std::string>& folders)
{
  const std::size_t begin = folder.find_first_not_of(' ');
  if (name.empty() || begin == std::string::npos)
    throw Error("parameter ~packages: a package without a name or a folder");
  if (folder[begin] != '/')
    throw Error("parameter ~packages: the folder '" + folder.substr(begin) + "' of package '" + name +
                "' is not an absolute path");
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

namespace
{
/// The parameters with the joint limits: those of the move_group that the node follows (~monitor). MoveIt searches
/// robot_description from the name of the move_group upwards. If it finds none, or without a move_group, they are those
/// of the node's own robot description.
std::string limitsFolder(const ros::NodeHandle& node, const ros::NodeHandle& own, const std::string& urdf_parameter)
{
  const std::string monitor = textParameter(own, "monitor", "");
  const ros::NodeHandle move_group(node, monitor);
  std::string found;
  if (monitor.empty() || !move_group.searchParam("robot_description", found))
    found = urdf_parameter;
  return found + "_planning";
}

/// ~solids: {LINK: auto | surface | filled}.
std::map<std::string, SolidRule> solidsFromParameters(const ros::NodeHandle& own)
{
  std::map<std::string, SolidRule> solids;
  XmlRpcValue values;
  if (!own.getParam("solids", values))
    return solids;
  const std::string where = "parameter " + own.resolveName("solids") + ": ";
  if (values.getType() != XmlRpcValue::TypeStruct)
    throw Error(where + "it must be a map {LINK: RULE}");
  for (auto& [link, rule] : values)
  {
    if (rule.getType() != XmlRpcValue::TypeString)
      throw Error(where + "the rule of link '" + link + "' must be auto, surface or filled");
    try
    {
      solids[link] = solidRuleFrom(static_cast<std::string&>(rule));
    }
    catch (const Error& error)
    {
      throw Error(where + "link '" + link + "': " + error.what());
    }
  }
  return solids;
}

/// The name of a robot description in messages: the file or command that the launch file names, or the parameter.
std::string sourceOf(const ros::NodeHandle& own, const std::string& source_parameter, const std::string& parameter)
{
  const std::string source = textParameter(own, source_parameter, "");
  return source.empty() ? "parameter " + parameter : source;
}
}  // namespace

PlanningScene sceneFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own, SceneDefaults& defaults,
                                  std::vector<std::string>* warnings)
{
  XmlRpcValue packages;
  std::map<std::string, std::string> folders;
  if (own.getParam("packages", packages))
    folders = packageFolders(packages);
  RobotModelOptions options;
  options.packages = packageResolver(folders, "name its folder in ~packages (launch file: \"packages:={NAME: DIR}\")");
  options.urdf_folder = textParameter(own, "urdf_folder", "");
  options.unbounded_translation = lengthParameter(own, "unbounded_translation", options.unbounded_translation);
  options.meshes = meshAccessFromParameters(own);

  const std::string urdf_parameter = searchedParameter(node, "robot_description");
  const std::string srdf_parameter = searchedParameter(node, "robot_description_semantic");
  options.urdf_name = sourceOf(own, "urdf_source", urdf_parameter);
  options.srdf_name = sourceOf(own, "srdf_source", srdf_parameter);
  const std::string urdf = textParameter(node, urdf_parameter, "");
  if (urdf.empty())
    throw Error("parameter " + urdf_parameter +
                " is not set; load the robot's URDF there, or give urdf:=FILE to the launch file");
  options.joint_limits = jointLimitsFromParameters(node, limitsFolder(node, own, urdf_parameter), warnings);
  const auto robot = RobotModel::fromXml(urdf, textParameter(node, srdf_parameter, ""), options, warnings)
                         ->withSolids(solidsFromParameters(own));
  defaults = defaultsFromParameters(node, urdf_parameter, *robot, warnings);

  const std::string scene_file = textParameter(own, "scene", "");
  if (!scene_file.empty() && scene_file[0] != '/' && scene_file.find("://") == std::string::npos)
    throw Error("parameter " + own.resolveName("scene") + ": '" + scene_file +
                "' is neither an absolute path nor a package:// or file:// URI");
  PlanningScene scene = scene_file.empty() ? PlanningScene(robot, defaults)
                                           : loadSceneFile(resolveUri(scene_file, "", options.packages), robot,
                                                           options.packages, warnings, options.meshes, defaults);
  if (XmlRpcValue operations; node.getParam(urdf_parameter + "_planning/default_collision_operations", operations))
    applyCollisionOperations(operations, node.resolveName(urdf_parameter + "_planning/default_collision_operations"),
                             scene, warnings);
  // So a later run of the node has larger revisions, and those of two runs are never equal: a node makes fewer changes
  // than microseconds pass.
  scene.revision = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count());
  return scene;
}

BatchCheckerOptions checkerOptionsFromParameters(const ros::NodeHandle& own)
{
  BatchCheckerOptions options;
  options.device = textParameter(own, "device", options.device);
  if (own.hasParam("traversal"))
    options.traversal = traversalFromName(textParameter(own, "traversal", ""));
  options.max_batch = countParameter(own, "max_batch", options.max_batch, 1, std::size_t{1} << 24);
  options.device_only = own.param("device_only", options.device_only);
  options.limits.device_seconds = positiveParameter(own, "device_timeout", options.limits.device_seconds);
  options.limits.max_losses = countParameter(own, "device_losses", options.limits.max_losses, 1, 1000);
  options.limits.retry_seconds = positiveParameter(own, "device_retry", options.limits.retry_seconds);
  return options;
}

SceneLimits sceneLimitsFromParameters(const ros::NodeHandle& own)
{
  SceneLimits limits;
  limits.objects = countParameter(own, "limits/objects", limits.objects, 0, kNoLimit);
  limits.shapes = countParameter(own, "limits/shapes", limits.shapes, 0, kNoLimit);
  limits.voxels = countParameter(own, "limits/voxels", limits.voxels, 1, kNoLimit);
  limits.triangles = countParameter(own, "limits/triangles", limits.triangles, 0, kNoLimit);
  limits.triangles_of_mesh = countParameter(own, "limits/triangles_of_mesh", limits.triangles_of_mesh, 0, kNoLimit);
  limits.frames = countParameter(own, "limits/frames", limits.frames, 0, kNoLimit);
  limits.colors = countParameter(own, "limits/colors", limits.colors, 0, kNoLimit);
  limits.name_length = countParameter(own, "limits/name_length", limits.name_length, 0, kNoLimit);
  limits.matrix_entries = countParameter(own, "limits/matrix_entries", limits.matrix_entries, 0, kNoLimit);
  return limits;
}

CheckServerOptions serverOptionsFromParameters(const ros::NodeHandle& own)
{
  CheckServerOptions options;
  options.small_request = countParameter(own, "small_request", options.small_request, 0, kNoLimit);
  options.max_waiting_requests = countParameter(own, "limits/waiting_requests", options.max_waiting_requests, 1, 1000);
  options.max_waiting_states = countParameter(own, "limits/waiting_states", options.max_waiting_states, 1, kNoLimit);
  options.max_states = countParameter(own, "limits/request_states", options.max_states, 1, kNoLimit);
  return options;
}

ServiceOptions serviceOptionsFromParameters(const ros::NodeHandle& own)
{
  ServiceOptions options;
  options.tf_timeout = lengthParameter(own, "tf_timeout", options.tf_timeout);
  options.full_scene_period = positiveParameter(own, "full_scene_period", options.full_scene_period);
  options.max_motion_checks = countParameter(own, "limits/motion_checks", options.max_motion_checks, 1, kNoLimit);
  options.max_inspected_states =
      countParameter(own, "limits/inspected_states", options.max_inspected_states, 0, kNoLimit);
  options.max_contacts = countParameter(own, "limits/contacts", options.max_contacts, 1, kNoLimit);
  options.max_memory = countParameter(own, "limits/memory", 0, 0, std::size_t{1} << 52);
  options.max_waiting_changes = countParameter(own, "limits/waiting_changes", options.max_waiting_changes, 1, kNoLimit);
  options.watch_rate = positiveParameter(own, "watch/rate", options.watch_rate);
  options.marker_rate = positiveParameter(own, "markers/rate", options.marker_rate);
  options.animation_rate = lengthParameter(own, "markers/animation_rate", options.animation_rate);
  options.marker_triangles = countParameter(own, "markers/triangles", options.marker_triangles, 0, kNoLimit);
  options.cloud_topic = textParameter(own, "cloud/topic", options.cloud_topic);
  options.cloud_id = textParameter(own, "cloud/id", options.cloud_id);
  if (options.cloud_id == kOctomapId)
    throw Error("parameter ~cloud/id is '" + options.cloud_id + "', the id of the octomap; choose another id");
  options.cloud.voxel = positiveParameter(own, "cloud/voxel", options.cloud.voxel);
  options.cloud.robot_padding = lengthParameter(own, "cloud/robot_padding", options.cloud.robot_padding);
  options.cloud.max_distance = positiveParameter(own, "cloud/range", options.cloud.max_distance);
  options.cloud.max_voxels = countParameter(own, "limits/voxels", options.cloud.max_voxels, 1, kNoLimit);
  options.message_size = static_cast<std::uint32_t>(
      countParameter(own, "limits/message_size", options.message_size, 1, std::size_t{1} << 30));
  return options;
}
}  // namespace gpu_planning_scene::core
